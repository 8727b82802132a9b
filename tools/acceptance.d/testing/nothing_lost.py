#!/usr/bin/env python3
"""kill -9 at random moments of runs, half of them paced by the wall clock: every log is readable, replays bit for bit as
far as it goes, and ends at most 100 ms before the last time on the run's status line. Half of the
kills come at once after such a line, the others up to a fifth of a second later."""
import os
import pty
import random
import re
import select
import signal
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import BEST, FOOTFALL, ROOT, SEED, finish, give_up, progress, progress_done, scratch

KILLS = int(os.environ.get("FOOTFALL_KILLS", "100"))
KEPT = 0.1  # s before the kill
RATE = 1500.0  # ticks per second


class Run:
    """A run with its status line on a separate terminal."""

    def __init__(self, folder, paced):
        self.terminal, theirs = pty.openpty()
        self.told, self.lines, self.text = 0.0, 0, ""
        self.process = subprocess.Popen(
            [FOOTFALL, "run", BEST, "--seed", str(SEED), "--no-report", "--for", "600s", "--log", str(folder),
             *(["--realtime"] if paced else [])],
            cwd=ROOT, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=theirs)
        os.close(theirs)

    def listen(self, seconds, lines=None):
        """Reads output for this time; returns early after `lines` status lines."""
        end = time.monotonic() + seconds
        while time.monotonic() < end and (lines is None or self.lines < lines):
            if self.process.poll() is not None:
                raise RuntimeError("the run ended before it was killed")
            if select.select([self.terminal], [], [], 0.01)[0]:
                self.text += os.read(self.terminal, 65536).decode(errors="replace")
                found = re.findall(r"t +(\d+\.\d\d) s ", self.text)
                self.lines = len(found)
                self.told = float(found[-1]) if found else 0.0

    def kill(self):
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()
        os.close(self.terminal)


def ticks_of(folder):
    done = subprocess.run([FOOTFALL, "replay", str(folder), "--verify"], cwd=ROOT, capture_output=True, text=True,
                          timeout=600)
    found = re.search(r"identical: (\d+) ticks", done.stdout)
    if not found:
        raise RuntimeError((done.stdout + done.stderr).strip()[:300])
    return int(found.group(1))


def lost_by_a_kill(folder, paced, lines, later):
    run = Run(folder, paced)
    try:
        run.listen(60.0, lines)
        run.listen(later)
    finally:
        run.kill()
    return run.told - ticks_of(folder) / RATE


generator = random.Random(SEED)
lost, problems = [], []
with scratch() as top:
    for k in range(KILLS):
        later = generator.uniform(0.0, 0.2) if k % 4 < 2 else 0.0
        try:
            lost.append(lost_by_a_kill(Path(top) / str(k), k % 2 == 0, generator.randint(1, 4), later))
        except (OSError, RuntimeError, subprocess.TimeoutExpired) as problem:
            problems.append(str(problem))
        progress(f"{k + 1} of {KILLS} kills")
    progress_done()
if not lost:
    give_up(problems[0] if problems else "no run")
finish(f"{KILLS} runs killed, {len(problems)} logs unreadable or not as run; of what was told at most "
       f"{max(0.0, *lost) * 1e3:.0f} ms lost" + (f" ({problems[0]})" if problems else ""),
       not problems and max(lost) <= KEPT)
