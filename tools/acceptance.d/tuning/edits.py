#!/usr/bin/env python3
"""Random edits at 500 a second, a third of them invalid in every way, some sent again, while the robot balances: each
is answered, a repeated one the same, none that is invalid is accepted, the values in force are always those of the
accepted ones and whole, no fall, and from the log's every tick: no joint's torque steps beyond the robot's bound while
edits move values."""
import csv
import json
import os
import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from live_runs import Engine, program, some_url
from rows import BEST, FOOTFALL, ROOT, SEED, finish, give_up, scratch

COUNT = int(os.environ.get("FOOTFALL_EDITS", "100000"))
RATE = 500.0  # 1/s
TICKS = 1500.0  # 1/s
SLOWEST_ANSWER = 20.0  # ms, want bar for p99


def edit_times(log):
    """When edits were applied, s."""
    done = subprocess.run([FOOTFALL, "events", log, "--kind", "edit", "--json"], cwd=ROOT, capture_output=True, text=True,
                          timeout=600)
    events = [json.loads(line) for line in done.stdout.splitlines()]
    return [e["time_s"] for e in events if e["name"].startswith("live")]


def largest_step(log, begin, end):
    """Largest change of a joint's commanded torque from one tick to the next between two times, Nm; part of the ticks
    that the log has with the one before (paced by the clock, a log drops ticks rather than let the tick wait)."""
    export = subprocess.Popen([FOOTFALL, "export", log, "--csv", "--all", "--signals", "joint.*.command", "--from",
                               f"{begin}s", "--to", f"{end}s"], cwd=ROOT, stdout=subprocess.PIPE, text=True)
    rows = csv.reader(export.stdout)
    next(rows)
    largest, pairs, before = 0.0, 0, None
    for row in rows:
        now = [float(x) for x in row]
        if before is not None and now[0] == before[0] + 1:
            largest = max(largest, *(abs(a - b) for a, b in zip(now[2:], before[2:])))
            pairs += 1
        before = now
    if export.wait():
        raise RuntimeError("footfall export failed")
    return largest, pairs / round((end - begin) * TICKS)


robot = (ROOT / "robots" / "hume" / "robot.yaml").read_text(encoding="utf-8")
bound = float(re.search(r"torque_step: ([\d.]+) Nm", robot)[1])
with scratch() as folder:
    log = str(Path(folder) / "log")
    try:
        url = some_url()
        with Engine(BEST, "--realtime", "--seed", SEED, "--for", f"{COUNT / RATE + 120}s", "--log-all", "--no-report",
                    "--log", log, url=url) as engine:
            load = program("live_edits", "--count", COUNT, "--rate", RATE, "--seed", SEED, url=url,
                           timeout=COUNT / RATE + 300)
            run, code = engine.stop()
        times = edit_times(log)
        if not times:
            raise RuntimeError("the log has no edits")
        step, seen = largest_step(log, times[0], times[-1])
    except (RuntimeError, OSError, subprocess.TimeoutExpired) as problem:
        give_up(problem)

live = run["live"]
counts = {
    "unanswered": load["unanswered"],
    "answered too often": load["answered_more_often_than_sent"] + load["unasked"],
    "repeated with another answer": load["repeated_differently"],
    "invalid applied": load["invalid_accepted"],
    "torn or lost": load["values_wrong"],
    "applied but not accepted": abs(live["applied"] - load["accepted"]) + max(0, len(times) - load["accepted"]),
    # A tick dropped by the log lost its edits, too.
    "accepted but not in the log": 0 if seen < 1.0 else load["accepted"] - len(times),
}
wrong = {name: count for name, count in counts.items() if count}
good = not wrong and not run["fell"] and code == 0 and step <= bound * (1.0 + 1e-6) and seen > 0.9 and load["values_compared"] > 0
answer = load["answer_ms"]
finish(f"{load['sent']} edits in {load['seconds']:.0f} s ({load['invalid']} invalid, {load['repeated']} sent again), "
       f"{load['accepted']} applied, {load['valid_refused']} valid ones refused, "
       f"{', '.join(f'{count} {name}' for name, count in wrong.items()) or 'none wrong'}; values compared "
       f"{load['values_compared']} times; {'fell' if run['fell'] else 'no fall'}; largest torque step {step:.2f} Nm of "
       f"{bound:g} ({seen:.1%} of the ticks); answers p50 {answer['p50']:.1f} ms, p99 {answer['p99']:.1f} ms, max "
       f"{answer['max']:.0f} ms", good, answer["p99"] < SLOWEST_ANSWER)
