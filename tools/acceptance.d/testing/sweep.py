#!/usr/bin/env python3
"""Usage: tools/acceptance.d/testing/sweep.py

Sweeps use all processors, and a kill loses no more than the active runs.
- A sweep of 200 runs of the tuned behavior (4 lift times x 5 gains x 10 seeds, 3 s each), two at a time: processor time
  of the runs over 2 x wall time. Compared with two endless loops on this machine at the same time, because a
  shared machine gives less than 2 cores.
- A sweep of 60 short runs is killed with SIGKILL at random moments until it is done: every run is there once, none was
  recorded twice, what was recorded before a kill is the same after it, and no child outlives its parent by 1 s.
With ACCEPTANCE_WANT 100 kills, else 30.
"""
import os
import random
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import rows  # noqa: E402

MUST = 0.90
KILLS = 100 if rows.WANT else 30


def sweep(out, *arguments):
    return [rows.FOOTFALL, "sweep", rows.BEST, "--out", str(out), "-j", str(rows.PROCESSES), "--no-report", *arguments]


def children_cpu():
    times = os.times()
    return times.children_user + times.children_system


def finished(out, what="id, finished, cpu_s"):
    path = out / "sweep.sqlite"
    if not path.exists():
        return []
    database = sqlite3.connect(path, timeout=10)
    try:
        return database.execute(f"SELECT {what} FROM runs WHERE status != 'pending' ORDER BY id").fetchall()
    except sqlite3.OperationalError:  # killed before the plan was stored
        return []
    finally:
        database.close()


def two_cores(seconds):
    """Processor time over wall time that two endless loops get: 2 on a machine of our own."""
    loops = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(rows.PROCESSES)]
    before, start = children_cpu(), time.monotonic()
    time.sleep(seconds)
    wall = time.monotonic() - start
    for loop in loops:
        loop.kill()
    for loop in loops:
        loop.wait()
    return (children_cpu() - before) / wall


def busy(folder):
    out = folder / "busy"
    available = two_cores(5.0)
    before, start = children_cpu(), time.monotonic()
    done = subprocess.run(sweep(out, "--vary", "lift_time=140ms..155ms:4", "--vary", "gains.single.swing.kp=[180,200,220,240,260]",
                                "--seeds", "100..109", "--for", "3s"),
                          cwd=rows.ROOT, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=900)
    wall, cpu = time.monotonic() - start, children_cpu() - before
    if done.returncode != 0:
        rows.give_up(f"the sweep ended with {done.returncode}: {(done.stderr or done.stdout).strip()[-300:]}")
    available = 0.5 * (available + two_cores(5.0))
    walls = [row[0] for row in finished(out, "wall_s")]
    return len(walls), cpu / wall, available, wall, sum(walls) / (rows.PROCESSES * wall)


def orphans():
    """Command lines of `footfall run` whose parent is not a living sweep."""
    found = []
    for entry in Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            words = (entry / "cmdline").read_bytes().split(b"\0")
            environment = (entry / "environ").read_bytes()
        except OSError:
            continue
        if words[1:2] == [b"run"] and b"FOOTFALL_SWEEP_ROW=1" in environment:
            found.append(entry.name)
    return found


def kills(folder):
    out = folder / "killed"
    chance = random.Random(1)
    command = sweep(out, "--vary", "lift_time=140ms..150ms:3", "--seeds", "100..119", "--for", "1s")
    environment = dict(os.environ, FOOTFALL_SWEEP_ROW="1")
    before, wrong, count = [], [], 0
    while count < KILLS:
        process = subprocess.Popen(command, cwd=rows.ROOT, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, env=environment)
        try:
            process.wait(chance.uniform(0.05, 2.5))
            ended = process.returncode
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
            process.wait()
            ended, count = None, count + 1
            time.sleep(1.0)
            if orphans():
                wrong.append(f"{len(orphans())} children outlived kill {count}")
        now = finished(out)
        if not set(before) <= set(now):
            wrong.append(f"kill {count} changed what was done")
        before = now
        rows.progress(f"{count} kills, {len(now)} runs done")
        if ended is not None:
            if ended != 0 or len(now) != 60:
                wrong.append(f"ended with {ended} after {len(now)} of 60 runs")
            if count < KILLS:  # next round
                out = folder / f"killed-{count}"
                command[command.index("--out") + 1] = str(out)
                before = []
    done = subprocess.run(command, cwd=rows.ROOT, stdin=subprocess.DEVNULL, capture_output=True, timeout=600)
    ids = [i for i, _, _ in finished(out)]
    if done.returncode != 0 or ids != list(range(60)) or not set(before) <= set(finished(out)):
        wrong.append(f"the last sweep ended with {done.returncode} and {len(ids)} of 60 runs")
    rows.progress_done()
    return count, wrong


def main():
    with rows.scratch() as name:
        runs, cores, available, wall, filled = busy(Path(name))
        share = cores / rows.PROCESSES
        fair = min(1.0, cores / min(available, rows.PROCESSES))
        count, wrong = kills(Path(name))
    figure = (f"{runs} runs in {wall:.0f} s: {100 * share:.1f} % of 2 cores, {100 * fair:.1f} % of the {available:.2f} that two "
              f"endless loops get here, a run in each of 2 places {100 * filled:.1f} % of the time; {count} kills, {'no run lost or repeated' if not wrong else '; '.join(wrong[:3])}")
    rows.finish(figure, runs == 200 and fair > MUST and not wrong, share > MUST)


if __name__ == "__main__":
    main()
