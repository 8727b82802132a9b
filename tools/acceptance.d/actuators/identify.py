#!/usr/bin/env python3
"""`footfall identify` finds random actuators: springs, rotors, friction and delay of robots and worlds drawn here, from the
log of the library's excitation on a hoist. `--quick`: 4 seeds instead of 20."""
import json
import random
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from math import sqrt
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import FOOTFALL, PROCESSES, ROOT, SEED, finish, give_up, progress, progress_done, run, scratch

SEEDS = range(SEED, SEED + (4 if "--quick" in sys.argv[1:] else 20))
JOINTS = [f"{side}_{joint}" for side in ("right", "left") for joint in ("abduction", "hip", "knee")]
TICK = 1 / 1500
MUST = {"spring": 0.05, "rotor": 0.05, "viscous": 0.05, "coulomb": 0.10}
WANT = {"spring": 0.02, "rotor": 0.02, "viscous": 0.02, "coulomb": 0.02}
KEYS = {"spring": "spring_Nm_per_rad", "rotor": "rotor_kgm2", "viscous": "viscous_Nms_per_rad", "coulomb": "coulomb_Nm"}


def draw(seed):
    """The truth: by joint spring and rotor; friction and delay of all. `nominal`: springs as the robot file has them."""
    rng = random.Random(seed)
    spring = [rng.uniform(200, 800) for _ in JOINTS]
    return {"spring": spring, "rotor": [rng.uniform(0.04, 0.2) for _ in JOINTS],
            "nominal": [k / (1 + rng.uniform(-0.1, 0.1)) for k in spring],
            "viscous": rng.uniform(0.2, 2), "coulomb": rng.uniform(0.3, 3),
            "delay": round(rng.uniform(0, 2 * TICK) * 12000) / 12000}


def write_files(folder, seed, truth):
    """Robot and world; the torque loops are damped as Hume's are."""
    robot, world = folder / f"robot_{seed}.yaml", folder / f"world_{seed}.yaml"
    joints = "".join(f"  {name}: {{sea: {{spring: {k:.9g} Nm/rad, rotor: {j:.9g} kg m^2}}}}\n"
                     for name, k, j in zip(JOINTS, truth["nominal"], truth["rotor"]))
    damping = ", ".join(f"{name}: {1.4 * sqrt(21 * k * j):.4g} Nm s/rad"
                        for name, k, j in zip(JOINTS, truth["nominal"], truth["rotor"]))
    robot.write_text(f"robot: 1\nname: hume_{seed}\nbase: {ROOT}/robots/hume/robot.yaml\njoints:\n{joints}"
                     f"drives: {{torque_loop: {{d: {{{damping}}}}}}}\n")
    springs = ", ".join(f'{name}: "{100 * (k / nominal - 1):+.9f} %"'
                        for name, k, nominal in zip(JOINTS, truth["spring"], truth["nominal"]))
    world.write_text(f"world: 1\nname: drawn_{seed}\nbase: {ROOT}/sim/worlds/sea_hoist.yaml\nactuators:\n"
                     f"  command_delay: {1e6 * truth['delay']:.4f} us\n  viscous: {truth['viscous']:.9g} Nm s/rad\n"
                     f"  coulomb: {truth['coulomb']:.9g} Nm\n  spring: {{{springs}}}\nvariation: {{actuators: off}}\n")
    return robot, world


def identified(folder, seed):
    truth = draw(seed)
    robot, world = write_files(Path(folder), seed, truth)
    log = Path(folder) / f"log_{seed}"
    run("behaviors/library/excite.yaml", "--robot", robot, "--world", world, "--seed", seed, "--log", log, log=True)
    done = subprocess.run([FOOTFALL, "identify", log, "--json"], cwd=ROOT, capture_output=True, text=True, timeout=600)
    if done.returncode not in (0, 1):
        raise RuntimeError(done.stderr.strip())
    return truth, json.loads(done.stdout)


def main():
    worst = dict.fromkeys(KEYS, 0.0)
    delay_worst, delay_bar, lacking, spread, results = 0.0, 0.0, 0, [], []
    with scratch() as folder, ThreadPoolExecutor(PROCESSES) as pool:
        try:
            for result in pool.map(lambda seed: identified(folder, seed), SEEDS):
                results.append(result)
                progress(f"{len(results)} of {len(SEEDS)} seeds")
        except (OSError, RuntimeError, ValueError, subprocess.TimeoutExpired) as problem:
            give_up(problem)
    progress_done()
    for truth, found in results:
        for j, joint in enumerate(found["joints"]):
            if joint["richness"] != "good" or "delay_s" not in joint:
                lacking += 1
                continue
            for name, key in KEYS.items():
                value = truth[name][j] if isinstance(truth[name], list) else truth[name]
                error = joint[key]["value"] - value
                worst[name] = max(worst[name], abs(error) / value)
                spread.append(abs(error) / joint[key]["error"])
            error = abs(joint["delay_s"]["value"] - truth["delay"])
            delay_worst = max(delay_worst, error / TICK)
            delay_bar = max(delay_bar, error / max(0.05 * TICK, 0.05 * truth["delay"]))
    count = len(results) * len(JOINTS)
    inside = sum(s <= 2 for s in spread) / max(1, len(spread))
    figure = (f"{count} actuators of {len(results)} seeds, worst errors: "
              + ", ".join(f"{name} {100 * worst[name]:.2f} %" for name in KEYS)
              + f", delay {delay_worst:.3f} ticks; {lacking} not identified; "
              f"{100 * inside:.0f} % of errors within 2 standard errors")
    within = lambda bars: lacking == 0 and delay_bar <= 1 and all(worst[n] <= bars[n] for n in bars)
    finish(figure, within(MUST), within(WANT))


main()
