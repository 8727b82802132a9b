#!/usr/bin/env python3
"""A clean clone: tools/demo and tools/test succeed with no other step; the second demo is quick."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import os
import subprocess
import time

from rows import ROOT, finish, scratch


def timed(clone, log, *command):
    """(exit code, seconds) of one command in the clone, with its own, initially empty compiler cache."""
    environment = dict(os.environ, CCACHE_DIR=str(clone / "out" / "ccache"))
    begin = time.monotonic()
    with open(log, "a", encoding="utf-8") as out:
        print(f"  {' '.join(command)}", file=sys.stderr, flush=True)
        code = subprocess.run(command, cwd=clone, env=environment, stdin=subprocess.DEVNULL, stdout=out,
                              stderr=out).returncode
    return code, time.monotonic() - begin


def clone(folder, name):
    path = Path(folder) / name
    subprocess.run(["git", "clone", "--quiet", "--no-hardlinks", str(ROOT), str(path)], check=True)
    return path


log = ROOT / "out" / "acceptance-newcomer.log"
log.parent.mkdir(exist_ok=True)
log.unlink(missing_ok=True)
with scratch() as folder:  # one clone per tool, so that neither uses the other's build
    tested, demo = clone(folder, "test"), clone(folder, "demo")
    test_code, test_seconds = timed(tested, log, "./tools/test", "--yes")
    demo_code, demo_seconds = timed(demo, log, "./tools/demo", "--yes")
    again_code, again_seconds = timed(demo, log, "./tools/demo", "--yes")
    pictures = all((demo / "out" / "demo" / f).is_file() for f in ("report.html", "strip.png", "log.mcap"))
figure = (f"test: exit {test_code} in {test_seconds:.0f} s; demo: exit {demo_code} in {demo_seconds:.0f} s, "
          f"again {again_seconds:.0f} s; report and strip {'there' if pictures else 'MISSING'}; log in {log.relative_to(ROOT)}")
passed = test_code == demo_code == again_code == 0 and pictures and again_seconds < 60 and test_seconds <= 480
finish(figure, passed, passed and again_seconds < 30)
