#!/usr/bin/env python3
"""On the wedges, compliant along x and stiff along z, no integrals: the stiffness against a force that is held for 2 s."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import bench, finish, pick

texts, passed = [], True
for case in pick(bench("bench_wedge_impedance"), "cases"):
    error = case["measured"] / case["expected"] - 1.0
    texts.append(f"{case['axis']}, planarizer {'known' if case['known'] else 'unknown'}: {case['measured']:.0f} N/m of "
                 f"{case['expected']:.0f} ({100 * error:+.1f} %)")
    passed = passed and (not case["known"] or abs(error) <= 0.05)
finish("; ".join(texts), passed)
