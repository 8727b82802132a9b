#!/usr/bin/env python3
"""Flaky tests of the quick set: repetitions on an idle machine and with every core loaded; all must pass."""
import os
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import FOOTFALL, PROCESSES, ROOT, WANT, finish, progress, progress_done, scratch

REPEATS = int(os.environ.get("FOOTFALL_REPEATS", 50 if WANT else 10))


def repeat(folder):
    """(seconds, first failing line or an empty text)."""
    begin = time.monotonic()
    done = subprocess.run([FOOTFALL, "test", "tests/runs/regression", "--quick", "-j", str(PROCESSES), "--out", folder,
                           "--no-report"], cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=1200)
    lines = [line for line in (done.stdout + done.stderr).splitlines() if line.strip()]
    return time.monotonic() - begin, "" if done.returncode == 0 else (lines or [f"exit {done.returncode}"])[0]


flakes, times = [], {False: [], True: []}
with scratch() as folder:
    for k in range(REPEATS):
        loaded = k >= REPEATS // 2
        load = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(os.cpu_count() if loaded else 0)]
        try:
            seconds, failure = repeat(folder)
        finally:
            for process in load:
                process.kill()
                process.wait()
        times[loaded].append(seconds)
        flakes += [failure] if failure else []
        progress(f"{k + 1} of {REPEATS} repeats")
progress_done()
finish(f"{len(flakes)} of {REPEATS} repeats failed{': ' + flakes[0] if flakes else ''}; at most {max(times[False]):.0f} s idle, "
       f"{max(times[True]):.0f} s loaded", not flakes, not flakes and REPEATS >= 50)
