#!/usr/bin/env python3
"""Coverage of the library's behaviors by the full set: states, transitions, outcomes of guards."""
import json
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import FOOTFALL, PROCESSES, ROOT, finish, give_up, scratch

LIBRARY = ROOT / "behaviors" / "library"

with scratch() as folder:
    result = Path(folder) / "coverage.json"
    done = subprocess.run([FOOTFALL, "test", "tests/runs/regression", "-j", str(PROCESSES), "--out", folder, "--no-report",
                           "--coverage", str(result)], cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          timeout=7200)
    if not result.exists():
        give_up((done.stderr.strip().splitlines() or ["no coverage written"])[-1])
    report = json.loads(result.read_text())
failed = [line for line in done.stdout.splitlines() if line.strip()][:1] if done.returncode else []
sums = {"states": [0, 0], "transitions": [0, 0], "guard_outcomes": [0, 0]}
for behavior in report["behaviors"]:
    if (ROOT / behavior["behavior"]).resolve().parent != LIBRARY:
        continue
    for key, total in sums.items():
        total[0] += behavior[key]["reached"]
        total[1] += behavior[key]["of"]
if not sums["states"][1]:
    give_up("no behavior of the library was run")
share = {key: 100.0 * reached / total if total else 100.0 for key, (reached, total) in sums.items()}
finish(", ".join(f"{key.replace('_', ' ')} {share[key]:.1f} % ({sums[key][0]} of {sums[key][1]})" for key in sums)
       + (f"; the set failed: {failed[0]}" if failed else ""),
       share["states"] == 100.0 and share["transitions"] >= 95.0 and not failed, share["guard_outcomes"] >= 95.0)
