#!/usr/bin/env python3
"""Timers at 1500 Hz: exact periods ten thousand times, no drift over a day."""
import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import BUILD, ROOT, finish, give_up

PROGRAMS = {"behaviors_test": "StatechartClock.*", "behaviors_day_test": "StatechartDay.*"}


def passed(program, tests):
    command = [str(BUILD / "tests" / "unit" / "behaviors" / program), f"--gtest_filter={tests}"]
    try:
        done = subprocess.run(command, cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=900)
    except (OSError, subprocess.TimeoutExpired) as problem:
        give_up(problem)
    ran = re.search(r"(\d+) tests? from \d+ test suites? ran", done.stdout)
    if not ran or ran.group(1) == "0":
        give_up(f"{program} ran no test of {tests}")
    return done.returncode == 0


clock, day = (passed(program, tests) for program, tests in PROGRAMS.items())
finish(f"16, 145 and 150 ms at 1500 Hz, 10 000 times each: {'24, 218 and 225 ticks always' if clock else 'WRONG'}; "
       f"129.6 million ticks one by one: {'no drift' if day else 'DRIFT'}", clock and day)
