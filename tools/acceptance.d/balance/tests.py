#!/usr/bin/env python3
"""Each equation that the code cites is cited by a test; ASan and UBSan are clean."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import os
import re
import subprocess

from rows import ROOT, finish

FOLDERS = ["core", "hal", "model", "tasks", "behaviors", "engine", "sim", "lab"]
CITED = re.compile(r"\beqs?\.?\s*((?:\(?\d+\)?(?:\s*(?:,|and|to|-|–)\s*(?:eqs?\.?\s*)?)?)+)")


def cited(folders):
    """{equation number: first file that cites it}, from `eq. (37)`, `eqs. 12-18`, `eq. (1), (2)`."""
    found = {}
    for path in sorted(p for f in folders for s in ("*.h", "*.cc") for p in (ROOT / f).rglob(s)):
        for match in CITED.finditer(path.read_text(encoding="utf-8")):
            for begin, end in re.findall(r"(\d+)\)?(?:\s*(?:to|-|–)\s*\(?(\d+))?", match.group(1)):
                for number in range(int(begin), int(end or begin) + 1):
                    found.setdefault(number, str(path.relative_to(ROOT)))
    return found


def sanitized(preset):
    """(clean, text) of the quick set under one sanitizer."""
    log = ROOT / "out" / f"acceptance-{preset}.log"
    log.parent.mkdir(exist_ok=True)
    with open(log, "w", encoding="utf-8") as out:
        for step in (["cmake", "--preset", preset], ["cmake", "--build", "--preset", preset],
                     ["ctest", "--preset", preset, "--parallel", str(os.cpu_count())]):
            if subprocess.run(step, cwd=ROOT, stdin=subprocess.DEVNULL, stdout=out, stderr=out).returncode:
                return False, f"{preset}: {' '.join(step[:1])} failed, see {log.relative_to(ROOT)}"
    count = re.findall(r"tests failed out of (\d+)", log.read_text(encoding="utf-8", errors="replace"))
    return bool(count), f"{preset}: {count[-1] if count else 0} tests clean"


used, tested = cited(FOLDERS), cited(["tests"])
untested = {n: where for n, where in used.items() if n not in tested}
clean = [sanitized(preset) for preset in ("asan", "ubsan")]
figure = f"{len(used)} equations cited by the code, {len(used) - len(untested)} of them by tests"
if untested:
    figure += " (not: " + ", ".join(f"eq. {n} of {where}" for n, where in sorted(untested.items())) + ")"
finish("; ".join([figure] + [text for _, text in clean]), used and not untested and all(c for c, _ in clean))
