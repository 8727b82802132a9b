#!/usr/bin/env python3
"""Same seed, two runs: the log files are identical byte for byte."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import hashlib

from rows import BALANCE, BEST, SEED, finish, give_up, run, scratch

CASES = {"in place": [BALANCE, "--seed", SEED, "--for", "20s"],
         "pushed": [BEST, "--seed", SEED + 1, "--for", "20s", "--push", "40,0.1,67.5,step 8 phase 0.5"]}


def digest(arguments, folder):
    run(*arguments, "--log", folder, log=True)
    data = (folder / "log.mcap").read_bytes()
    return len(data), hashlib.sha256(data).hexdigest()


same, parts = True, []
with scratch() as folder:
    for name, arguments in CASES.items():
        try:
            first, second = (digest(arguments, Path(folder) / f"{name.replace(' ', '_')}-{i}") for i in (1, 2))
        except (OSError, RuntimeError, ValueError) as problem:
            give_up(problem)
        same = same and first == second and first[0] > 0
        parts.append(f"{name}: {first[0]} and {second[0]} bytes, {first[1][:12]} and {second[1][:12]}")
finish("; ".join(parts), same)
