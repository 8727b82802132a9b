#!/usr/bin/env python3
"""Internal force control in the dual phases of a walk in `lab`: 100 seeds of 300 steps each with feedback and without,
the same seeds; the force's error in the phases; and with phases of 150 ms, its second half. Stride for stride the seeds
draw what `lab` draws: start, springs, friction of the joints, sensors' noise, masses, the floor below each step."""
import csv
import io
import math
import statistics
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from lab_runs import counted, steps_of

from rows import FOOTFALL, ROOT, finish, run, scratch

FORCES = "balance_lab_forces"
# Long phases need a planner whose time to reversal is above half of the longer step.
LONG = """behavior: 1
base: {base}
parameters: {{dual_time: {{value: 150 ms}}}}
planners: {{foot: {{reversal: [260 ms, 250 ms]}}}}
"""


def rms(values):
    return math.sqrt(sum(v * v for v in values) / len(values))


def phase_errors(behavior, seed, folder, *options):
    """The error of the tension, N, by dual phase: a list of lists of ticks."""
    log = Path(folder) / f"log-{seed}-{len(list(Path(folder).iterdir()))}"
    run(behavior, "--world", "lab", "--seed", seed, "--steps", 40, "--log", log, "--log-all", *options, log=True)
    text = subprocess.run([FOOTFALL, "export", str(log), "--csv", "--all", "--signals", "internal.*"], cwd=ROOT,
                          capture_output=True, text=True, check=True).stdout
    phases, current = [], []
    for row in csv.DictReader(io.StringIO(text)):
        reference, measured = row["internal.tension.reference"], row["internal.tension.measured"]
        if reference in ("", "nan"):
            phases.append(current)
            current = []
        else:
            current.append(float(measured) - float(reference))
    return [phase for phase in phases + [current] if phase][1:]  # after the first stand


def errors(behavior, seeds, folder, feedback):
    """Medians over phases: rms in the first half, in the second half, in the last 4 ms."""
    options = ["--set", f"force_feedback={feedback}"]
    phases = [p for seed in seeds for p in phase_errors(behavior, seed, folder, *options)]
    parts = (lambda p: p[:len(p) // 2], lambda p: p[len(p) // 2:], lambda p: p[-6:])
    return len(phases), [statistics.median(rms(part(p)) for p in phases) for part in parts]


def main():
    seeds = range(100, 200)
    with_force = steps_of(FORCES, seeds, 300)
    without = steps_of(FORCES, seeds, 300, "--set", "force_feedback=0")
    fell = [sum(s < 300 for s in runs.values()) for runs in (with_force, without)]
    text = [f"with feedback {counted(with_force, 300)}", f"without {counted(without, 300)}"]
    with scratch() as folder:
        long = Path(folder) / "long.yaml"
        long.write_text(LONG.format(base=ROOT / "behaviors" / "library" / f"{FORCES}.yaml"))
        halves, ends = [], []
        for name, behavior, count in (("16 ms", FORCES, 4), ("150 ms", str(long), 20)):
            for feedback in (0, 2):
                phases, (first, second, last) = errors(behavior, range(100, 100 + count), folder, feedback)
                text.append(f"{name}, K_F {feedback}, {phases} phases: {first:.3f} N rms in the first half, {second:.3f} in "
                            f"the second, {last:.3f} in the last 4 ms")
                halves.append(second)
                ends.append(last)
    finish("; ".join(text), fell[0] <= fell[1] + 3 and halves[3] <= 0.5 * halves[2], ends[1] <= 0.5 * ends[0])


if __name__ == "__main__":
    main()
