#!/usr/bin/env python3
"""Cost of live tuning in the tick: telemetry at its default rate and in every tick, 500 edits/s; heap calls, locks."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import bench, finish, pick

BAR = 1.1
passed, texts = True, []
for rate in ("50", "1500"):
    figures = bench("bench_live", rate)
    ratio = float(pick(figures, "ratio"))
    calls = pick(figures, "allocations") + pick(figures, "locks")
    texts.append(f"{rate} Hz: {ratio:.3f} of the tick's CPU time without, {pick(figures, 'allocations')} heap calls, "
                 f"{pick(figures, 'locks')} locks")
    passed &= ratio <= BAR and calls == 0 and not pick(figures, "fell")
finish("; ".join(texts), passed)
