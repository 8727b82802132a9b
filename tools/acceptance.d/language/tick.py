#!/usr/bin/env python3
"""A tick of a chart of 200 states, 4 regions, 400 transitions against the WBOSC algebra."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import bench, finish, pick

figures = bench("bench_statechart")
size = [pick(figures, key) for key in ("states", "regions", "transitions")]
ratio = {key: float(pick(figures, key, "over_algebra")) for key in ("without", "with_one", "with_one_in_every_region")}
taken, allocations = pick(figures, "different_transitions_taken"), pick(figures, "allocations")
figure = (f"{ratio['without']:.3f} x the algebra ({float(pick(figures, 'algebra_us')):.2f} us) without a transition, "
          f"{ratio['with_one']:.3f} x with one, {ratio['with_one_in_every_region']:.3f} x with one in every region; "
          f"{allocations} allocations in {pick(figures, 'lively_ticks')} ticks that take {taken} of {size[2]} transitions")
passed = size == [200, 4, 400] and allocations == 0 and taken == size[2]
finish(figure, passed and ratio["without"] <= 0.3 and ratio["with_one"] <= 0.7,
       passed and ratio["without"] <= 0.15 and ratio["with_one"] <= 0.35)
