#!/usr/bin/env python3
"""Two clients at once add to one parameter, each expecting the revision that it read: no change is lost, conflicts
are reported, and each receives the other's change within 0.2 s after it was sent."""
import os
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from live_runs import Engine, program, some_url
from rows import BEST, SEED, finish, give_up

COUNT = int(os.environ.get("FOOTFALL_CHANGES", "150"))  # changes per client
SOON = 200.0  # ms, limit

try:
    url = some_url()
    with Engine(BEST, "--realtime", "--seed", SEED, "--for", "300s", "--no-log", url=url) as engine:
        seen = program("live_operators", "--count", COUNT, "--parameter", "lift_time", url=url)
        run, code = engine.stop()
except (RuntimeError, OSError, subprocess.TimeoutExpired) as problem:
    give_up(problem)
finish(f"{seen['changes']} changes by two, {seen['conflicts']} conflicts answered, {seen['lost']} lost, "
       f"{seen['unanswered']} unanswered, {seen['unheard']} not heard by the other; heard after "
       f"{seen['heard_ms']['p50']:.0f} ms (median), {seen['heard_ms']['max']:.0f} ms at most",
       seen["changes"] == 2 * COUNT and seen["lost"] == seen["unanswered"] == seen["unheard"] == 0 and
       seen["conflicts"] > 0 and seen["heard_ms"]["max"] <= SOON and code == 0 and not run["fell"])
