#!/usr/bin/env python3
"""Each legal pair of fault and reaction on each backend: event, count, log row, ticks to the reaction, replay."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import re
import subprocess

from rows import BUILD, ROOT, finish, give_up

program = BUILD / "tests" / "unit" / "engine" / "engine_test"
if not program.is_file():
    give_up("engine_test is not built")
done = subprocess.run([program, "--gtest_filter=*FaultReaction*", "--gtest_brief=1"], cwd=ROOT, capture_output=True, text=True)
ran = re.findall(r"^\[=+\] (\d+) tests? from .* ran", done.stdout, flags=re.M)
passed = re.findall(r"^\[  PASSED  \] (\d+) tests?", done.stdout, flags=re.M)
finish(f"{passed[-1] if passed else 0} of {ran[-1] if ran else 0} pairs on mujoco and stub", done.returncode == 0 and bool(ran)
       and int(ran[-1]) > 0)
