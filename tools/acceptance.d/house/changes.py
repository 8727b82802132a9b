#!/usr/bin/env python3
"""Five changes that people make, kept as patches: each applies to the tree as it is, and touches few files."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import re
import subprocess

from rows import ROOT, finish

NAMES = {"task_type", "estimator", "sensor_field", "statistic", "lcm_message"}
WANTED = 3

done = subprocess.run([sys.executable, ROOT / "tests" / "changes" / "apply_changes.py", ROOT], capture_output=True, text=True)
counts = {name: int(count) for name, count in re.findall(r"^ok: (\w+)\.patch touches (\d+):", done.stdout, flags=re.M)}
missing = sorted(NAMES - counts.keys())
figure = ", ".join(f"{name} {count}" for name, count in sorted(counts.items())) + " files"
finish(figure + "".join(f"; {name} does not hold" for name in missing), done.returncode == 0 and not missing,
       not missing and max(counts.values()) <= WANTED)
