#!/usr/bin/env python3
"""Library behaviors of 20 s on the stub in lock-step: how long, and the same bytes twice."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import hashlib
import subprocess
import time

from rows import FOOTFALL, ROOT, finish, give_up, scratch

slowest, alike, ends = 0.0, True, []
with scratch() as folder:
    for name in sorted(p.stem for p in (ROOT / "behaviors/library").glob("*.yaml")):
        command = [FOOTFALL, "run", name, "--backend", "stub", "--for", "20 s", "--quiet"]
        best = 1e9
        for _ in range(5):
            start = time.monotonic()
            done = subprocess.run([*command, "--no-log"], cwd=ROOT, capture_output=True, text=True)
            best = min(best, time.monotonic() - start)
        if done.returncode not in (0, 1):
            give_up(f"{name}: {done.stderr.strip()[-200:]}")
        ends.append(f"{name} {'to its end' if done.returncode == 0 else 'FAILED'} in {best:.2f} s")
        slowest = max(slowest, best) if done.returncode == 0 else 1e9
        digests = set()
        for k in range(2):
            log = f"{folder}/{name}-{k}"
            subprocess.run([*command, "--no-report", "--log", log], cwd=ROOT, capture_output=True)
            digests.add(hashlib.sha256(open(f"{log}/log.mcap", "rb").read()).hexdigest())
        alike = alike and len(digests) == 1
finish(f"{'; '.join(ends)}; logs {'the same' if alike else 'NOT the same'} twice", slowest < 0.5 and alike)
