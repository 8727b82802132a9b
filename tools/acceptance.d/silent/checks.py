#!/usr/bin/env python3
"""The physics checks against what happens.

Planner: the 10 584 settings (kappa, time to reversal t', step time T) of planner_test, which steps planner and pendulum and
knows no eigenvalue, and a sample of them as behavior files that `footfall check` judges; here the step-to-step map is made by
stepping, and its complex eigenvalues are computed.

Gains: random gain sets of `balance_best`, each one task of the stride with its gains multiplied by factors drawn
log-uniformly. `check` accepts the file, warns (only a robot would be unstable, or small errors in height lift the feet), or
refuses. Then all of them step for 5 s. What is refused runs too: as parameters that the first state sets, which `check` cannot
know. An accepted set, run in this way, is the same run to the last digit (tried on some). Sets that are warned of count in
neither class.

`--planner N`, `--gains N`, `--seed N` set the samples (0: leave out), `--list` prints each gain set that did not as was said,
`--save FILE` writes all of them as JSON."""
import argparse
import cmath
import json
import math
import random
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from rows import BUILD, FOOTFALL, PROCESSES, ROOT, SEED, finish, give_up, last_json, progress, progress_done, scratch

PROGRAM = str(Path(FOOTFALL).resolve())
SETTINGS = [(0.05 * i, 0.1 + 0.02 * j, 0.2 + 0.02 * k) for i in range(21) for j in range(21) for k in range(24)]
HEIGHT, GRAVITY = 0.9, 9.81
MARGIN = 1e-7  # of the modulus 1
BEFORE_LIFT = 0.040  # s of a step: dual support and the contact transition
PLANNER = """base: balance_best
parameters: {{lift_time: {{value: {half!r}, range: [1 ms, 1 s]}}, land_time: {{value: {half!r}, range: [1 ms, 1 s]}}}}
planners: {{foot: {{kappa: [{kappa!r}, {kappa!r}], reversal: [{reversal!r}, {reversal!r}]}}}}
stacks: {{single: {{tasks: {{height: {{reference: {height!r}}}}}}}}}
"""
TEST = "FootPlanner.OfAllSettingsExactlyThoseThatGrowHaveAnEigenvalueBeyondOne"

# Tasks that are in force while it steps. `sway` starts it only, `limp` ends it, and `coast` asks for nothing.
TASKS = ("dual.height", "dual.attitude", "dual.heading", "single.height", "single.attitude", "single.place", "single.swing")
LEAST, MOST = 1 / 3, 1e4  # factor of a gain: about half of the sets are then refused
SECONDS = 5
WARNINGS = ("unstable-gains", "lifts-feet")
WIDE = "ranges: {kp: [0, 1e12], ki: [0, 1e12], kd: [0, 1e12]}"
# An axis may bound its own acceleration (heading: 5 rad/s^2). Unstable, it jumps between the bounds: `rms` of what is
# commanded is then near the bound; as shipped it is 1.2.
BOUND = 5.0
SATURATED = 0.8 * BOUND


def modulus(kappa, reversal, step):
    """Largest |eigenvalue| of the map of (x, v) from one change of support to the next, both from the goal: the foot is put
    by the planner's law, then the CoM falls over it for a step."""
    w = math.sqrt(GRAVITY / HEIGHT)
    columns = []
    for x, v in ((1.0, 0.0), (0.0, 1.0)):
        foot = x + v / (w * math.tanh(w * reversal)) + kappa * x
        columns.append((foot + (x - foot) * math.cosh(w * step) + v / w * math.sinh(w * step),
                        (x - foot) * w * math.sinh(w * step) + v * math.cosh(w * step)))
    (a, c), (b, d) = columns
    root = cmath.sqrt((a - d) ** 2 / 4 + b * c)
    return max(abs((a + d) / 2 + root), abs((a + d) / 2 - root))


def diagnostics(file):
    done = subprocess.run([PROGRAM, "check", file.name, "--json"], cwd=file.parent, stdin=subprocess.DEVNULL, capture_output=True,
                          text=True, timeout=120)
    return json.loads(done.stdout)["files"][0]["diagnostics"]


def judge_setting(job):
    """(stable by the oracle or None at the border, refused) of a setting."""
    folder, number, (kappa, reversal, step) = job
    file = folder / f"planner-{number}.yaml"
    file.write_text(PLANNER.format(half=(step - BEFORE_LIFT) / 2, kappa=kappa, reversal=reversal, height=HEIGHT))
    found = diagnostics(file)
    other = [d for d in found if d["severity"] == "error" and d["id"] in ("type", "unit", "unknown-key", "out-of-range", "syntax")]
    if other:
        raise ValueError(other[0]["text"])
    refused = [d for d in found if d["severity"] == "error" and d["id"] == "unstable-planner"]
    for d in refused:  # that the file is what it is taken for
        if f"height h {HEIGHT:.3f} m, step time T {step:.3f} s" not in d["text"]:
            raise ValueError("judged at another height or time: " + d["text"])
    size = modulus(kappa, reversal, step)
    return None if abs(size - 1) < MARGIN else size < 1, bool(refused)


def planner_part(folder, pool, count, generator):
    """Text and whether it is as it should be."""
    test = BUILD / "tests" / "unit" / "behaviors" / "planner_test"
    if not test.exists():
        give_up(f"{test} is not built")
    done = subprocess.run([str(test), f"--gtest_filter={TEST}"], capture_output=True, text=True, timeout=600)
    all_good = done.returncode == 0 and "[  PASSED  ] 1 test" in done.stdout
    sample = generator.sample(SETTINGS, min(count, len(SETTINGS)))
    passed = refused = stable_ones = border = 0
    for done, (stable, no) in enumerate(pool.map(judge_setting, ((folder, n, s) for n, s in enumerate(sample))), 1):
        progress(f"{done} of {len(sample)} settings of the planner")
        border += stable is None
        stable_ones += stable is True
        passed += stable is False and not no
        refused += stable is True and no
    text = (f"planner: {len(SETTINGS)} settings in planner_test {'as they should' if all_good else 'FAILED'}; of {len(sample)} files "
            f"({stable_ones} stable, {border} at the border) unstable passed {passed}, stable refused {refused}")
    return text, all_good and passed == refused == 0


def shipped_gains():
    """{task: {kp: [...], ...}} of balance_best."""
    told = subprocess.run([PROGRAM, "signals", "balance_best", "gains.*"], cwd=ROOT, capture_output=True, text=True, timeout=60).stdout
    gains = {}
    for task, gain, values in re.findall(r"^gains\.(\S+)\.(k.)\s.*gain (\[.*?\]|\S+),", told, flags=re.M):
        if task in TASKS:
            gains.setdefault(task, {})[gain] = [float(v) for v in values.strip("[]").split(",")]
    if set(gains) != set(TASKS):
        give_up(f"balance_best has not the gains of {', '.join(TASKS)}")
    return gains


def listed(values):
    return values[0] if len(values) == 1 else f"[{', '.join(values)}]"


def as_values(task, gains):
    table, name = task.split(".")
    return f"base: balance_best\ngains: {{{WIDE}, {table}: {{{name}: {{{', '.join(f'{k}: {listed([repr(x) for x in v])}' for k, v in gains.items())}}}}}}}\n"


def as_variables(task, gains, shipped):
    table, name = task.split(".")
    uses = ", ".join(f"{k}: " + listed([f'"= ${k}{i}"' for i in range(len(v))]) for k, v in gains.items())
    begin = ", ".join(f"{k}{i}: {{value: {shipped[k][i]!r}}}" for k, v in gains.items() for i in range(len(v)))
    sets = ", ".join(f"{k}{i}: {x!r}" for k, v in gains.items() for i, x in enumerate(v))
    return (f"base: balance_best\nparameters: {{{begin}}}\ngains: {{{WIDE}, {table}: {{{name}: {{{uses}}}}}}}\n"
            f"machine: {{states: {{sway: {{on_entry+: [{{set: {{{sets}}}}}]}}}}}}\n")


def run(folder, behavior, seed):
    """The result of 5 s on `flat`."""
    scenario = behavior.with_suffix(".run.yaml")
    scenario.write_text(f"scenario: 1\nbehavior: {behavior.name}\nworld: flat\nfor: {SECONDS} s\n"
                        'expect: [{that: "rms(task.heading.commanded.yaw) < 1000"}, {end: time}]\n')
    done = subprocess.run([PROGRAM, "run", scenario.name, "--seed", str(seed), "--no-log", "--quiet", "--json"], cwd=folder,
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300)
    if done.returncode not in (0, 1):
        raise ValueError(done.stderr.strip()[-300:])
    return last_json(done.stdout)


def judge_set(job):
    """A gain set with the verdict of `check` and what its run came to."""
    folder, number, task, gains, shipped = job
    values, variables = folder / f"values-{number}.yaml", folder / f"set-{number}.yaml"
    values.write_text(as_values(task, gains))
    variables.write_text(as_variables(task, gains, shipped))
    told = diagnostics(values)
    errors = [d for d in told if d["severity"] == "error"]
    # Of these values themselves: the ends of ranges are of no interest here.
    warned = [d for d in told if d["severity"] == "warning" and d["id"] in WARNINGS and "at the end of the range" not in d["text"]]
    if [d for d in errors if d["id"] != "unstable-gains"]:
        raise ValueError(errors[0]["text"])
    result = run(folder, variables, SEED + number)
    figures = result["figures"]
    rms = result["expectations"][0]["values"].get("rms task.heading.commanded.yaw", 0.0)
    found = {"set": number, "task": task, "gains": gains, "refused": bool(errors), "warned": bool(warned), "text": errors[0]["text"] if errors else "",
             "end": result["end"], "time_s": figures["time_s"], "torque_limit_ticks": figures["fault_ticks"].get("torque.limit", 0),
             "bounded": rms is not None and rms > SATURATED, "cause": (figures["cause"] or {}).get("text")}
    if not errors and number % 10 == 0:
        same = run(folder, values, SEED + number)["figures"]
        found["same"] = all(same[key] == figures[key] for key in ("time_s", "end_m", "error", "peak_torque_Nm", "path_length_m"))
    return found


def reaches(found):
    return found["end"] == "time"


def falls_or_saturates(found):
    return not reaches(found) or found["torque_limit_ticks"] > 0 or found["bounded"]


def why(found):
    """What is known of a set that did not as `check` said."""
    gains = found["gains"]
    period = 1 / 1500
    kp, kd = max(gains["kp"]), max(gains["kd"])
    text = f"kd T {kd * period:.2f}, kp T/(2 kd) {max(p / d for p, d in zip(gains['kp'], gains['kd'])) * period / 2:.2f}"
    text += f", {1e-3 * kp + 1e-2 * kd:.3g} m/s^2 (or rad/s^2) for an error of 1 mm and 1 cm/s"
    text += f", damping {min(d / (2 * math.sqrt(p)) for p, d in zip(gains['kp'], gains['kd'])):.2f}"
    if "ki" in gains:
        text += f", ki/(kp kd) {max(i / (p * d) for i, p, d in zip(gains['ki'], gains['kp'], gains['kd'])):.2g}"
    end = f"{found['end']} at {found['time_s']:.2f} s, torque at its limit in {found['torque_limit_ticks']} ticks"
    told = "; " + found["text"] if found["refused"] else ""
    return f"{found['task']} set {found['set']}: {text}; kp {kp:.4g}, kd {kd:.4g}: {end}{told}"


def draw(shipped, generator):
    task = generator.choice(TASKS)
    factors = {gain: math.exp(generator.uniform(math.log(LEAST), math.log(MOST))) for gain in ("kp", "ki", "kd")}
    return task, {gain: [float(f"{v * factors[gain]:.6g}") for v in values] for gain, values in shipped[task].items()}


def gains_part(folder, pool, count, generator, options):
    shipped = shipped_gains()
    sets = [(folder, n, *draw(shipped, generator)) for n in range(count)]
    found = []
    for one in pool.map(judge_set, ((*s, shipped[s[2]]) for s in sets)):
        found.append(one)
        progress(f"{len(found)} of {count} gain sets")
    refused = [f for f in found if f["refused"]]
    warned = [f for f in found if f["warned"] and not f["refused"]]
    accepted = [f for f in found if not f["warned"] and not f["refused"]]
    wrong = [f for f in accepted if not reaches(f)] + [f for f in refused if not falls_or_saturates(f)]
    if options.list:
        progress_done()
        print("\n".join(why(f) for f in wrong))
    if options.save:
        Path(options.save).write_text(json.dumps(found, indent=1))
    different = sum(f.get("same") is False for f in found)
    good, bad = sum(map(reaches, accepted)), sum(map(falls_or_saturates, refused))
    run_too = [f for f in found if not f["refused"]]
    text = (f"gains: of {len(accepted)} accepted {good} reach {SECONDS} s ({sum(map(reaches, run_too))} of {len(run_too)} with those warned of), of {len(refused)} refused {bad} fall or saturate "
            f"({sum(not reaches(f) for f in refused)} fall), of {len(warned)} warned of {sum(not reaches(f) for f in warned)} fall")
    if different:
        text += f"; {different} sets run otherwise as variables than as values"
    return text, not different and good >= 0.95 * len(accepted) and bad >= 0.95 * len(refused) and len(found) >= 200


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--planner", type=int, default=300)
    parser.add_argument("--gains", type=int, default=200)
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--save")
    options = parser.parse_args()
    texts, good = [], True
    with scratch() as name, ThreadPoolExecutor(PROCESSES) as pool:
        parts = [(planner_part, options.planner, ()), (gains_part, options.gains, (options,))]
        for part, count, more in parts:
            if count:
                text, fine = part(Path(name), pool, count, random.Random(options.seed), *more)
                texts.append(text)
                good = good and fine
    progress_done()
    finish("; ".join(texts), good and len(texts) == 2)


main()
