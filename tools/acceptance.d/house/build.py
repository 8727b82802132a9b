#!/usr/bin/env python3
"""Clean clones without a compiler cache: seconds to build `footfall`, and for tools/test alone; then a changed source file of
behaviors/ until it runs in `footfall` and in its test. Wants a machine that does nothing else."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import os
import subprocess
import time

from rows import ROOT, finish, give_up, progress, progress_done, scratch

MUST = {"footfall": 150, "tools/test": 330, "change in footfall": 15, "change in its test": 20}
WANTED = {"footfall": 100, "tools/test": 240, "change in footfall": 8, "change in its test": 10}
CHANGED = "behaviors/planners/foot_planner.cc"
ENVIRONMENT = dict(os.environ, CCACHE_DISABLE="1")


def run(folder, *command):
    """Seconds that a command takes."""
    progress(" ".join(command[:4]))
    begin = time.monotonic()
    done = subprocess.run(command, cwd=folder, env=ENVIRONMENT, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode:
        give_up(f"{' '.join(command[:4])} failed: {(done.stderr or done.stdout).strip()[-300:]}")
    return time.monotonic() - begin


def clone(folder):
    subprocess.run(["git", "clone", "--quiet", str(ROOT), str(folder)], check=True)
    return folder


seconds = {}
with scratch() as name:
    first, second = clone(Path(name) / "first"), clone(Path(name) / "second")
    run(first, "cmake", "--preset", "release")
    seconds["footfall"] = run(first, "cmake", "--build", "--preset", "release", "--target", "footfall")
    seconds["tools/test"] = run(second, "tools/test", "--yes")
    for label, target, command in (
            ("change in footfall", "footfall", ["build/release/apps/footfall", "--version"]),
            ("change in its test", "planner_test", ["build/release/tests/unit/behaviors/planner_test", "--gtest_brief=1"])):
        source = second / CHANGED
        source.write_text(source.read_text(encoding="utf-8") + f"// {label}\n", encoding="utf-8")
        seconds[label] = run(second, "cmake", "--build", "--preset", "release", "--target", target) + run(second, *command)
progress_done()
finish(", ".join(f"{label} {value:.0f} s" for label, value in seconds.items()),
       all(seconds[label] <= most for label, most in MUST.items()), all(seconds[label] <= most for label, most in WANTED.items()))
