#!/usr/bin/env python3
"""40 logs in the world `lab`, 20 seeds of each estimator that reads sensors, 10 s each: `footfall replay --verify` finds
every tick bit for bit, the estimator included. That logs of before there were estimators are read is a unit test."""
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import FOOTFALL, PROCESSES, ROOT, SEED, finish, progress, progress_done, scratch, unit

SEEDS = range(SEED, SEED + 20)


def call(*arguments):
    return subprocess.run([FOOTFALL, *map(str, arguments)], cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True,
                          text=True, timeout=600)


def problem_of(behavior, seed, folder):
    """Empty if the log replays, else the reason."""
    done = call("run", behavior, "--world", "lab", "--for", "10s", "--seed", seed, "--no-report", "--quiet", "--log", folder)
    if done.returncode not in (0, 1):
        return f"{behavior}, seed {seed}: {done.stderr.strip()[:200]}"
    done = call("replay", folder, "--verify")
    if done.returncode == 0 and re.match(r"identical: [1-9]\d* ticks", done.stdout):
        return ""
    return f"{behavior}, seed {seed}: {(done.stdout + done.stderr).strip()[:300]}"


cases = [(behavior, seed) for behavior in ("balance_lab", "balance_no_mocap") for seed in SEEDS]
problems = []
with scratch() as top, ThreadPoolExecutor(PROCESSES) as pool:
    jobs = [pool.submit(problem_of, behavior, seed, Path(top) / f"{behavior}-{seed}") for behavior, seed in cases]
    for k, job in enumerate(jobs):
        problems += [job.result()] if job.result() else []
        progress(f"{k + 1} of {len(cases)} logs")
    progress_done()
old, _ = unit("lab/lab_test", "OldLog.WithoutMarkersAndEstimationIsReadReplayedAndReported")
if problems:
    print("\n".join(problems), file=sys.stderr)
finish(f"{len(cases) - len(problems)} of {len(cases)} logs bit for bit; a log of before is {'' if old else 'NOT '}read",
       not problems and old)
