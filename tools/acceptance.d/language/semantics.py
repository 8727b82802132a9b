#!/usr/bin/env python3
"""The conformance suite, one file a paragraph of docs/behaviors.md section 8, and random charts against Appendix D in Python."""
import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import BUILD, ROOT, finish, give_up

CHARTS, SEED = 10000, 2000000
FOLDER = ROOT / "tests" / "language" / "conformance"


def output(command):
    try:
        done = subprocess.run([str(c) for c in command], cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, timeout=900)
    except (OSError, subprocess.TimeoutExpired) as problem:
        give_up(problem)
    return done.returncode, done.stdout


files = sorted(FOLDER.glob("*.yaml"))
code, text = output([BUILD / "tests" / "language" / "conformance" / "conformance_test", *files])
ran, passed = (re.search(pattern, text) for pattern in (r"(\d+) tests? from \d+ test suites? ran", r"PASSED  \] (\d+)"))
if not ran:
    give_up("the conformance suite did not run")
cases, good = int(ran.group(1)), int(passed.group(1)) if passed else 0
agree, lines = output([sys.executable, FOLDER / "reference.py", BUILD / "tests" / "language" / "conformance" / "trace_many", CHARTS, SEED])
if not lines.strip():
    give_up("the reference interpreter did not run")
finish(f"{good} of {cases} cases pass, in {len(files)} files; {lines.strip().splitlines()[-1]} from Appendix D",
       code == 0 and agree == 0 and good == cases >= 80)
