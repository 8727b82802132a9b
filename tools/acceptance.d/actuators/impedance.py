#!/usr/bin/env python3
"""The largest stable stiffness of a leg (behavior leg_impedance) over gains of the torque loops, their damping and the
command's delay: bisection in simulation against the sampled model; and late damping against late stiffness."""
import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import BUILD, FOOTFALL, PROCESSES, ROOT, bench, finish, give_up, last_json, progress, progress_done, scratch

WITHIN = 0.15  # of the model
BRACKET = [0.75, 1.25]  # of the model; outside: no figure is needed, the row fails
RESOLUTION = 0.01
KICK = 6.0  # s: a state `spring` of the behavior begins at its raise + 2 settle
TRENDS = {"fixed": (-1, 0.1), "scheduled": (-1, 0.0), "scheduled_and_task": (+1, 0.1)}  # direction, at least
TESTS = BUILD / "tests" / "unit" / "hal" / "hal_test"
SCENARIO = """scenario: 1
behavior: {behavior}
world: {world}
for: {end} s
expect:
  - {{that: "rms(joint.right_hip.velocity) < 1000", between: [{first} s, {first_end} s]}}
  - {{that: "rms(joint.right_hip.velocity) < 1000", between: [{last} s, {end} s]}}
"""
WORLD = """world: 1
name: hoist_{ticks}
base: {base}
actuators: {{command_delay: {delay} us}}
"""


def prepare(folder, ticks):
    """A world with this delay and the scenario in it; the scenario's path."""
    world = folder / f"hoist_{ticks}.yaml"
    world.write_text(WORLD.format(ticks=ticks, base=ROOT / "sim/worlds/hoist.yaml", delay=ticks * 1e6 / 1500))
    scenario = folder / f"leg_{ticks}.yaml"
    scenario.write_text(SCENARIO.format(behavior=ROOT / "behaviors/library/leg_impedance.yaml", world=world,
                                        first=KICK + 0.1, first_end=KICK + 0.4, last=KICK + 1.7, end=KICK + 2.2))
    return scenario


def is_stable(scenario, case, kp):
    """Whether the hip swings less 1.6 s later."""
    values = {"stiffness": kp, "damping": case["kd"], "torque_loop.leg.p": case["p"]}
    values.update({f"torque_loop.leg.d.{joint}": d for joint, d in case["d"].items()})
    command = [FOOTFALL, "run", str(scenario), "--json", "--quiet", "--no-log"]
    for name, value in values.items():
        command += ["--set", f"{name}={value!r}"]
    done = subprocess.run(command, cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300)
    if done.returncode not in (0, 1):
        raise RuntimeError(f"exit {done.returncode} from {' '.join(command)}: {done.stderr.strip()[:300]}")
    result = last_json(done.stdout)
    if result["end"] != "time":
        return False
    early, late = (list(e["values"].values())[0] for e in result["expectations"])
    return late < early


def measure(scenarios, case):
    """The largest stable kp in simulation; None: not within the bracket."""
    scenario = scenarios[case["delay_ticks"]]
    good, bad = (share * case["kp"] for share in BRACKET)
    if not is_stable(scenario, case, good) or is_stable(scenario, case, bad):
        return None
    while bad - good > RESOLUTION * case["kp"]:
        middle = 0.5 * (good + bad)
        if is_stable(scenario, case, middle):
            good = middle
        else:
            bad = middle
    return 0.5 * (good + bad)


def trends_hold(rows):
    """Whether each curve over the torque gain goes the way of TRENDS, by more than the resolution allows."""
    for (law, _), curve in rows.items():
        sign, least = TRENDS[law]
        if any(sign * (b - a) < -RESOLUTION * a for a, b in zip(curve, curve[1:])):
            return False
        if sign * (curve[-1] - curve[0]) <= least * curve[0]:
            return False
    return True


def late_parts(folder):
    """The longest stable delays of damping and of stiffness alone, periods; by the unit tests, which compare with
    a simulated drive."""
    if not TESTS.exists():
        give_up(f"{TESTS} is not built")
    out = folder / "tests.json"
    done = subprocess.run([str(TESTS), "--gtest_filter=ImpedanceDelay.*", f"--gtest_output=json:{out}"], cwd=ROOT,
                          stdin=subprocess.DEVNULL, capture_output=True, timeout=300)
    cases = [c for suite in json.loads(out.read_text())["testsuites"] for c in suite["testsuite"]]
    found = {key: int(c[key]) for c in cases for key in ("late_damping_periods", "late_stiffness_periods") if key in c}
    if len(found) != 2:
        give_up("hal_test has no ImpedanceDelay")
    return found["late_damping_periods"], found["late_stiffness_periods"], done.returncode == 0


def main():
    cases = bench("bench_impedance")["cases"]
    with scratch() as name:
        folder = Path(name)
        scenarios = {ticks: prepare(folder, ticks) for ticks in {c["delay_ticks"] for c in cases}}
        measured = []
        with ThreadPoolExecutor(PROCESSES) as pool:
            try:
                for value in pool.map(lambda case: measure(scenarios, case), cases):
                    measured.append(value)
                    progress(f"{len(measured)} of {len(cases)} stiffnesses")
            except (OSError, RuntimeError, ValueError, subprocess.TimeoutExpired) as problem:
                pool.shutdown(wait=False, cancel_futures=True)
                progress_done()
                give_up(problem)
        progress_done()
        damping, stiffness, tested = late_parts(folder)
    rows, worst, outside = {}, 0.0, 0
    for case, kp in zip(cases, measured):
        name = f"{case['law']}, {case['delay_ticks']} tick, P {case['p']:g}"
        print(f"{name}: model {case['kp']:.0f} 1/s^2, simulated {'-' if kp is None else format(kp, '.0f')}",
              file=sys.stderr)
        if kp is None:
            outside += 1
            continue
        worst = max(worst, abs(kp / case["kp"] - 1.0))
        rows.setdefault((case["law"], case["delay_ticks"]), []).append(kp)
    trends = not outside and trends_hold(rows)
    spans = "; ".join(f"{law} {ticks}: {curve[0]:.0f} to {curve[-1]:.0f}" for (law, ticks), curve in rows.items())
    finish(f"{len(cases)} stiffnesses, worst {100 * worst:.1f} % from the model, {outside} beyond 25 %; 1/s^2 from the least "
           f"to the largest torque gain, law and ticks of delay: {spans}; trends {'hold' if trends else 'do NOT hold'}; "
           f"stable with {damping} ticks of late damping, with {stiffness} of late stiffness",
           not outside and worst <= WITHIN and trends and tested and stiffness > damping)


if __name__ == "__main__":
    main()
