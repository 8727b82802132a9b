#!/usr/bin/env python3
"""Internal forces with ideal actuators: that internal torque accelerates nothing (unit tests), and that the forces asked for are
those that MuJoCo reports, on two, three and four feet, moving, on level ground and on wedges, across contact changes."""
import csv
import io
import math
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import FOOTFALL, ROOT, SEED, finish, give_up, run, scratch, unit

SETTLED = 0.03  # s after a contact change
BAR = 0.1  # N rms
# Behavior, world, options. The behaviors that stand on slopes for ever are ended.
CASES = [("wedges_ellipse", "wedges", ["--for", "12 s", "--set", "world.constraints.planarizer.known=true"]), ("triped_circle", "ideal", []), ("triped_lift", "ideal", []),
         ("quadruped_circle", "ideal", []), ("quadruped_lift", "ideal", [])]
TESTS = [("tasks/tasks_test", "Quadruped.ForcesBetweenAllMoveNothing"),
         ("tasks/tasks_test", "Quadruped.TheWarpLoadsOneDiagonalAndUnloadsTheOther"),
         ("tasks/tasks_test", "WboscTension.ATensionMovesNothingInAnyState")]


def rows_of(behavior, world, options):
    with scratch() as folder:
        done = run(behavior, "--world", world, "--seed", SEED, "--log", folder, "--log-all", *options, log=True)
        if done["end"] not in ("finished", "time"):
            give_up(f"{behavior} in {world}: {done['end']}")
        named = [] if "lift" in behavior else ["internal.*"]  # these hold all of them at 0 N, without a name
        text = subprocess.run([FOOTFALL, "export", folder, "--csv", "--all", "--signals", *named, "force.*", "force_cmd.*",
                               "support.*", "contact.*"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return csv.DictReader(io.StringIO(text))


def errors(behavior, world, options):
    """Largest rms over the contacts' axes of predicted minus MuJoCo's force, and over the internal forces of measured minus
    reference; N."""
    contact, internal = {}, {}
    support, changed, before = None, 0.0, None
    for row in rows_of(behavior, world, options):
        time = float(row["time"])
        feet = {key[8:]: value for key, value in row.items() if key.startswith("support.")}
        changing = any(float(row[f"contact.{foot}"]) != float(holds) for foot, holds in feet.items())  # or in a transition
        if feet != support or changing:
            support, changed = feet, time
        commanded, before = before, row  # what is measured in a tick is under the torque of the tick before
        if time - changed < SETTLED or commanded is None:
            continue
        for foot, holds in feet.items():
            if float(holds) != 1.0:
                continue
            for axis in "xyz":
                error = float(commanded[f"force_cmd.{foot}.{axis}"]) - float(row[f"force.{foot}.{axis}"])
                contact.setdefault((foot, axis), []).append(error)
        for key, value in row.items():
            if key.startswith("internal.") and key.endswith(".reference") and value not in ("", "nan"):
                internal.setdefault(key, []).append(float(row[key.replace("reference", "measured")]) - float(value))
    rms = lambda lists: max((math.sqrt(sum(v * v for v in e) / len(e)) for e in lists.values()), default=math.inf)
    return rms(contact), rms(internal)


def main():
    texts, passed = [], True
    for program, test in TESTS:
        good, _ = unit(program, test)
        passed = passed and good
        texts.append(f"{test} {'holds' if good else 'FAILS'}")
    for behavior, world, options in CASES:
        contact, internal = errors(behavior, world, options)
        named = f", internal {internal:.3f}" if math.isfinite(internal) else ""
        texts.append(f"{behavior} in {world}: MuJoCo's forces {contact:.3f} N rms{named}")
        passed = passed and contact <= BAR and (internal <= BAR or "lift" in behavior)
    finish("; ".join(texts), passed)


if __name__ == "__main__":
    main()
