#!/usr/bin/env python3
"""start_stop_lab in `lab_harness`: 20 seeds from hanging on the rope to step 100 and back onto it."""
import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import FOOTFALL, ROOT, finish, give_up, scratch

SCENARIO = "tests/runs/regression/start_stop_lab.yaml"
with scratch() as folder:
    done = subprocess.run([FOOTFALL, "test", SCENARIO, "--seeds", "100..119", "-j", "2", "--out", folder], cwd=ROOT,
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=900)
    if done.returncode not in (0, 1):
        give_up(done.stderr.strip()[-200:])
failed = set(re.findall(r"(?:not in|failed in) ([\d ]+)", done.stdout))
seeds = sorted({int(s) for text in failed for s in text.split()})
finish(f"{20 - len(seeds)} of 20 to step 100 and back onto the rope, which bore nothing in between"
       + (f"; not {seeds}" if seeds else ""), done.returncode == 0)
