#!/usr/bin/env python3
"""Expressions: speed against muParser in one process, agreement with it on random ones."""
import os
import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import BUILD, bench, finish, give_up, pick

RANDOM = 100_000


def agreement():
    """(number of random expressions, number evaluated by muParser) if all results are bit-identical, else None."""
    program = BUILD / "tests" / "unit" / "behaviors" / "expression_oracle_test"
    if not program.exists():
        give_up(f"{program} is not built")
    done = subprocess.run([str(program)], env=dict(os.environ, FOOTFALL_EXPRESSIONS=str(RANDOM)),
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=600)
    found = re.search(r"^(\d+) expressions equal to the walk, (\d+) of them to muParser$", done.stdout, flags=re.M)
    return (int(found[1]), int(found[2])) if found and done.returncode == 0 else None


figures = bench("bench_expression")
slower = [row["expression"] for row in pick(figures, "rows") if row["ratio"] > 1]
count, twice = int(pick(figures, "expressions")), int(pick(figures, "twice_as_fast"))
agreed = agreement()
figure = (f"{count} expressions: median {float(pick(figures, 'median_ratio')):.2f} x muParser's time, worst "
          f"{float(pick(figures, 'worst_ratio')):.2f} x, at most half of it on {twice}; "
          + (f"{agreed[0]} random ones evaluate by the rules, {agreed[1]} of them (all parts finite) as muParser does, "
             "to the last bit" if agreed else "random ones differ")
          + "".join(f"; slower: {text}" for text in slower))
passed = not slower and float(pick(figures, "largest_difference")) <= 1e-12 and agreed is not None and agreed[0] == RANDOM
finish(figure, passed, passed and twice == count)
