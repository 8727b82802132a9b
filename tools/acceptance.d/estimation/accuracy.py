#!/usr/bin/env python3
"""Usage: tools/acceptance.d/estimation/accuracy.py [--table]

Errors of both estimators in the world `lab`, against the simulator's truth. Control on the true state (`balance_best`,
whose sensors each estimator then replays) and on the estimate (`balance_lab`, `balance_no_mocap`): 60 s each of ten
seeds, and ten minutes of three without motion capture. A figure is that of the worst seed; the NEES is the mean.

  --table  also prints the median and the worst of every figure, as docs/estimation.md has them
Exit: 0 every must holds, 1 one does not, 4 it could not be measured.
"""
import json
import math
import statistics
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import FOOTFALL, PROCESSES, ROOT, SEED, finish, give_up, last_json, progress, progress_done, scratch

SEEDS = range(SEED, SEED + 10)
LONG_SEEDS = range(SEED, SEED + 3)
SETTLED = {"motion_capture": 2, "contact_kalman": 20}  # s, from when on errors count
CALIBRATED = ("--set", "world.sensors.mocap.placement=0m")
DEGREE = math.pi / 180
LOSS = """scenario: 1
behavior: balance_best
world: lab
for: 10.5 s
script: [{at: 10 s, fault: mocap.dropout, for: 0.5 s}]
expect: [steps >= 20]
"""
# Bars: name, unit's factor, must. The want is half of it; of the NEES, within 0.5 and 2 of its dimension.
BARS = [
    ("mocap.calibrated rms", "mrad", 3.0), ("mocap.calibrated max", "mrad", 10.0),
    ("mocap rms", "mrad", 10.0), ("mocap max", "mrad", 20.0), ("mocap.loop rms", "mrad", 10.0),
    ("mocap.loop max", "mrad", 20.0), ("mocap.loss max", "mrad", 10.0), ("mocap com", "mm/s", 20.0),
    ("mocap.loop com", "mm/s", 20.0), ("kalman tilt", "mrad", 8.0), ("kalman.loop tilt", "mrad", 8.0),
    ("kalman.long tilt", "mrad", 8.0), ("kalman bias", "deg/s", 0.02), ("kalman.loop bias", "deg/s", 0.02),
]


def call(*arguments, codes=(0, 1)):
    done = subprocess.run([FOOTFALL, *map(str, arguments)], cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True,
                          text=True, timeout=1800)
    if done.returncode not in codes:
        raise RuntimeError(f"exit {done.returncode} from {' '.join(map(str, arguments))}: {done.stderr.strip()[:300]}")
    return done.stdout


def replayed(log, estimator, since):
    return last_json(call("replay", log, "--estimator", estimator, "--from", since, "--json", codes=(0,)))


def recorded(behavior, seed, seconds, folder, *more):
    """A run's log. One that falls shows in what follows: an estimate is no excuse for a fall."""
    result = last_json(call("run", behavior, "--world", "lab", "--for", f"{seconds}s", "--seed", seed, "--log", folder,
                            "--no-report", "--quiet", "--json", *more))
    return folder, float(result["time_s"]) >= seconds - 0.01


def job(top, kind, seed):
    """Figures {part: JSON of a replay} of one kind of run."""
    folder = Path(top) / f"{kind}-{seed}"
    if kind == "loss":
        return {"mocap.loss": lost(folder, seed)}
    behavior = {"mocap.loop": "balance_lab", "kalman.loop": "balance_no_mocap", "kalman.long": "balance_no_mocap"}.get(
        kind, "balance_best")
    log, stood = recorded(behavior, seed, 600 if kind == "kalman.long" else 60, folder,
                          *(CALIBRATED if kind == "mocap.calibrated" else ()))
    parts = {"both": ("mocap", "kalman")}.get(kind, (kind,))
    out = {}
    for part in parts:
        estimator = "motion_capture" if part.startswith("mocap") else "contact_kalman"
        out[part] = replayed(log, estimator, SETTLED[estimator])
        out[part]["stood"] = stood
    subprocess.run(["rm", "-r", "--", str(folder)], check=True)
    return out


def lost(folder, seed):
    """After half a second without a marker: the error of the last ticks."""
    folder.mkdir()
    scenario = folder / "loss.yaml"
    scenario.write_text(LOSS, encoding="utf-8")
    call("test", scenario, "--seeds", seed, "-j", 1, "--keep", "--no-report", "--out", folder / "out")
    logs = sorted((folder / "out").rglob("*.mcap"))
    if len(logs) != 1:
        raise RuntimeError(f"{len(logs)} logs of the run without markers")
    figures = replayed(logs[0].parent, "motion_capture", 10.49)
    figures["stood"] = True
    return figures


def figure(name, j):
    """Of one replay, in the unit of its bar."""
    what = name.split()[-1]
    if what in ("rms", "max"):
        return 1e3 * j["orientation_rad"]["norm"][what]
    if what == "tilt":
        return 1e3 * max(j["orientation_rad"][axis]["rms"] for axis in ("roll", "pitch"))
    if what == "com":
        return 1e3 * max(j["com_velocity_at_plans_mps"][axis]["rms"] for axis in "xyz")
    return max(abs(j["gyro_bias_error_radps"][axis]) for axis in "xy") / DEGREE


def measure():
    jobs = [("kalman.long", s) for s in LONG_SEEDS]
    jobs += [(kind, s) for kind in ("both", "mocap.calibrated", "mocap.loop", "kalman.loop", "loss") for s in SEEDS]
    results = {}
    with scratch() as top, ThreadPoolExecutor(PROCESSES) as pool:
        futures = [pool.submit(job, top, *what) for what in jobs]
        for k, future in enumerate(futures):
            try:
                for part, figures in future.result().items():
                    results.setdefault(part, []).append(figures)
            except (OSError, RuntimeError, ValueError, KeyError, subprocess.TimeoutExpired) as problem:
                pool.shutdown(wait=False, cancel_futures=True)
                progress_done()
                give_up(f"{jobs[k]}: {problem!r}")
            progress(f"{k + 1} of {len(jobs)} runs")
    progress_done()
    return results


results = measure()
worst = {name: max(figure(name, j) for j in results[name.split()[0]]) for name, _, _ in BARS}
nees = {part: statistics.mean(j["nees"]["mean"] / j["nees"]["dimension"] for j in results[part])
        for part in ("kalman", "kalman.loop", "kalman.long")}
apart = {part: {kind: statistics.mean(j["nees"][kind]["mean"] / j["nees"][kind]["dimension"] for j in results[part])
                for kind in ("tilt", "velocity", "place")} for part in nees}
grows = all(j["heading_deviation_rad"]["to"] > j["heading_deviation_rad"]["from"] > 0
            for part in nees for j in results[part])
gaps = sum(j["without_state"] for part in results for j in results[part])
falls = sum(not j["stood"] for part in results for j in results[part])
if "--table" in sys.argv[1:]:
    for name, unit, must in BARS:
        values = [figure(name, j) for j in results[name.split()[0]]]
        print(f"| {name} | {statistics.median(values):.3g} | {max(values):.3g} {unit} | {must:g} |")
failed = [name for name, _, must in BARS if not worst[name] <= must]
failed += [f"NEES of {part}" for part, value in nees.items() if not 0.5 <= value <= 2]
failed += ["yaw's deviation"] * (not grows) + [f"{gaps} ticks without a state"] * (gaps > 0) + [f"{falls} falls"] * (falls > 0)
w = worst
finish(f"motion_capture {w['mocap rms']:.1f} mrad rms, {w['mocap max']:.1f} max (loop {w['mocap.loop rms']:.1f}, "
       f"{w['mocap.loop max']:.1f}), LEDs in place {w['mocap.calibrated rms']:.2f}, {w['mocap.calibrated max']:.2f}, after "
       f"0.5 s without any {w['mocap.loss max']:.1f}, CoM {w['mocap com']:.1f} mm/s (loop {w['mocap.loop com']:.1f}); "
       f"contact_kalman tilt {w['kalman tilt']:.1f} mrad (loop {w['kalman.loop tilt']:.1f}, 10 min "
       f"{w['kalman.long tilt']:.1f}), bias {w['kalman bias']:.4f} deg/s (loop {w['kalman.loop bias']:.4f}), NEES "
       f"{nees['kalman']:.2f} of its dimension (loop {nees['kalman.loop']:.2f}, 10 min {nees['kalman.long']:.2f}; in the loop tilt "
       f"{apart['kalman.loop']['tilt']:.2f}, velocity {apart['kalman.loop']['velocity']:.2f}, place "
       f"{apart['kalman.loop']['place']:.2f}), yaw's "
       f"deviation {'grows' if grows else 'does NOT grow'}" + (f"; MISSED: {', '.join(failed)}" if failed else ""),
       not failed, not failed and all(worst[name] <= must / 2 for name, _, must in BARS))
