#!/usr/bin/env python3
"""Folders, includes, files and functions keep the bounds of docs/folders.md."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import statistics
import subprocess
from collections import Counter

from rows import ROOT, finish

tracked = subprocess.run(["git", "ls-files", "*.cc", "*.h"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
product = [f for f in tracked if not f.startswith("tests/")]
per_folder = Counter(str(Path(f).parent) for f in tracked)
lengths = {f: len((ROOT / f).read_text(encoding="utf-8").splitlines()) for f in product}
done = subprocess.run([sys.executable, ROOT / "tools" / "check_layers"], cwd=ROOT, capture_output=True, text=True)
problems = [line for line in done.stderr.splitlines() if ": error:" in line]
folder, count = per_folder.most_common(1)[0]
longest = max(lengths, key=lengths.get)
median = statistics.median(lengths.values())
figure = (f"{len(per_folder)} folders, at most {count} sources ({folder}); longest file {lengths[longest]} lines ({longest}), "
          f"median {median:g}; check_layers: {len(problems)} problems")
finish(figure + "".join(f"; {p}" for p in problems[:2]),
       done.returncode == 0 and count <= 22 and lengths[longest] <= 400, median < 90)
