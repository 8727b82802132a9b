#!/usr/bin/env python3
"""Model errors, one at a time (want: all at once): 300 steps each."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import BEST, ROOT, SEED, WANT, finish, give_up, run_all

STEPS = 300
WORLDS = {"masses -10 %": "mass_minus_10", "masses +10 %": "mass_plus_10", "friction 0.3": "slippery",
          "servo delay 2 ms": "delay_2ms"}
WANTED = {"all four, masses -10 %": "all_errors_light", "all four, masses +10 %": "all_errors_heavy"}

worlds = dict(WORLDS, **(WANTED if WANT else {}))
for world in worlds.values():
    if not (ROOT / "sim" / "worlds" / f"{world}.yaml").is_file():
        give_up(f"sim/worlds/{world}.yaml is missing")
results = run_all([(name, [BEST, "--seed", SEED, "--steps", STEPS, "--world", f"sim/worlds/{world}.yaml"])
                   for name, world in worlds.items()])
reached = {name: r["steps"] >= STEPS and not r["fell"] for name, r in results.items()}
figure = "; ".join(f"{name}: {r['steps']} steps" + ("" if reached[name] else f" ({r['end']})")
                   for name, r in results.items())
passed = all(reached[name] for name in WORLDS)
finish(figure, passed, all(reached.values()) if WANT else None)
