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
CASES = [("balance", "ideal", ["--steps", "20"]), ("wedges_ellipse", "wedges", ["--for", "12 s", "--set", "world.constraints.planarizer.known=true"]), ("triped_circle", "ideal", []), ("triped_lift", "ideal", []),
         ("quadruped_circle", "ideal", []), ("quadruped_lift", "ideal", [])]
TESTS = [("tasks/tasks_test", "Quadruped.ForcesBetweenAllMoveNothing"),
         ("tasks/tasks_test", "Quadruped.TheWarpLoadsOneDiagonalAndUnloadsTheOther"),
         ("tasks/tasks_test", "WboscTension.ATensionMovesNothingInAnyState")]


def rows_of(behavior, world, options):
    with scratch() as folder:
        done = run(behavior, "--world", world, "--seed", SEED, "--log", folder, "--log-all", *options, log=True)
        if done["end"] not in ("finished", "time", "steps"):
            give_up(f"{behavior} in {world}: {done['end']}")
        named = [] if "lift" in behavior or behavior == "balance" else ["internal.*"]  # these hold all of them at 0 N, without a name
        text = subprocess.run([FOOTFALL, "export", folder, "--csv", "--all", "--signals", *named, "force.*", "force_cmd.*", "force_est.*",
                               "support.*", "contact.*"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return csv.DictReader(io.StringIO(text))


def errors(behavior, world, options):
    """Largest rms, N, over the contacts' axes of predicted minus MuJoCo's force, and of the one by measured torques minus
    MuJoCo's; over the internal forces of measured minus reference; the part of the ticks that count."""
    contact, estimate, internal, count, total = {}, {}, {}, 0, 0
    support, changed, before = None, 0.0, None
    for row in rows_of(behavior, world, options):
        time = float(row["time"])
        feet = {key[8:]: value for key, value in row.items() if key.startswith("support.")}
        changing = any(float(row[f"contact.{foot}"]) != float(holds) for foot, holds in feet.items())  # or in a transition
        if feet != support or changing:
            support, changed = feet, time
        total += 1
        commanded, before = before, row  # what is measured in a tick is under the torque of the tick before
        if time - changed < SETTLED or commanded is None:
            continue
        count += 1
        for foot, holds in feet.items():
            if float(holds) != 1.0:
                continue
            for axis in "xyz":
                error = float(commanded[f"force_cmd.{foot}.{axis}"]) - float(row[f"force.{foot}.{axis}"])
                contact.setdefault((foot, axis), []).append(error)
                error = float(row[f"force_est.{foot}.{axis}"]) - float(row[f"force.{foot}.{axis}"])
                estimate.setdefault((foot, axis), []).append(error)
        for key, value in row.items():
            if key.startswith("internal.") and key.endswith(".reference") and value not in ("", "nan"):
                internal.setdefault(key, []).append(float(row[key.replace("reference", "measured")]) - float(value))
    rms = lambda lists: max((math.sqrt(sum(v * v for v in e) / len(e)) for e in lists.values()), default=math.inf)
    return rms(contact), rms(estimate), rms(internal), count / total


def main():
    texts, passed = [], True
    for program, test in TESTS:
        good, _ = unit(program, test)
        passed = passed and good
        texts.append(f"{test} {'holds' if good else 'FAILS'}")
    for behavior, world, options in CASES:
        contact, estimate, internal, share = errors(behavior, world, options)
        named = f", internal {internal:.3f}" if math.isfinite(internal) else ""
        texts.append(f"{behavior} in {world}: MuJoCo's forces {contact:.3f} N rms from those predicted, {estimate:.3f} from "
                     f"those of the torques{named} ({100 * share:.0f} % of the ticks)")
        passed = passed and max(contact, estimate) <= BAR and (internal <= BAR or not named)
    finish("; ".join(texts), passed)


if __name__ == "__main__":
    main()
