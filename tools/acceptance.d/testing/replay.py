#!/usr/bin/env python3
"""100 logs of short runs (library and examples, seeds, pushes, goals, live values) replay bit for bit; one bit of one
gain in the behavior is located: the gain is named, and the first tick that differs."""
import math
import os
import random
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import FOOTFALL, PROCESSES, ROOT, SEED, finish, progress, progress_done, scratch

LOGS = int(os.environ.get("FOOTFALL_LOGS", "100"))
GAIN = "gains.single.place.kp"


def call(*arguments):
    return subprocess.run([FOOTFALL, *map(str, arguments)], cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True,
                          text=True, timeout=600)


def behaviors():
    """Behaviors with a robot, by path."""
    found = sorted(Path(ROOT, "behaviors/library").glob("*.yaml")) + sorted(Path(ROOT, "examples").glob("*.yaml"))
    runnable = [p for p in found if re.search(r"^(robot|base):", p.read_text(encoding="utf-8"), flags=re.M)]
    return [str(p.relative_to(ROOT)) for p in runnable]


def case(k, generator, names):
    arguments = [names[k % len(names)], "--seed", SEED + k, "--for", f"{generator.uniform(1.0, 3.0):.2f}s"]
    if k % 3 == 1:
        push = (generator.uniform(10, 60), 0.1, generator.uniform(0, 360), generator.uniform(0.2, 1.0))
        arguments += ["--push", "{:.1f},{},{:.1f},{:.2f}".format(*push)]
    if k % 3 == 2 and "balance" in names[k % len(names)]:
        arguments += ["--goal", f"{generator.uniform(-0.2, 0.2):.3f},0", "--goal-velocity", "0.05,0.02",
                      "--set", "lift_time=150ms"]
    return arguments


def replayed(arguments, folder):
    """Empty if the log replays, else the reason. Falls are included."""
    done = call("run", *arguments, "--no-report", "--quiet", "--log", folder)
    if done.returncode not in (0, 1):
        return f"{' '.join(map(str, arguments))}: {done.stderr.strip()[:200]}"
    done = call("replay", folder, "--verify")
    if done.returncode == 0 and re.match(r"identical: [1-9]\d* ticks", done.stdout):
        return ""
    return f"{' '.join(map(str, arguments))}: {(done.stdout + done.stderr).strip()[:300]}"


def gain_located(folder):
    """A change of one bit in one gain must be reported first, with both values, and with the first differing tick."""
    call("run", "balance_best", "--seed", SEED, "--for", "2s", "--no-report", "--quiet", "--log", folder / "log")
    values = gains()
    wrong = list(values)
    wrong[1] = math.nextafter(values[1], math.inf)
    file = folder / "one_bit.yaml"
    base = Path(ROOT, "behaviors/library/balance_best.yaml")
    file.write_text(f"base: {base}\ngains:\n  single:\n    place: {{kp: [{', '.join(map(repr, wrong))}]}}\n", encoding="utf-8")
    done = call("replay", folder / "log", "--verify", "--behavior", file)
    named = f"{GAIN}[1]: {values[1]:g} in the log, {wrong[1]!r} now" in done.stdout
    return done.returncode == 1 and named and "first difference: tick" in done.stdout, done.stdout


def gains():
    text = Path(ROOT, "behaviors/library/balance_best.yaml").read_text(encoding="utf-8")
    found = re.search(r"single:.*?place: *\{kp: *\[([^\]]*)\]", text, flags=re.S)
    return [float(x) for x in found.group(1).split(",")]


generator = random.Random(SEED)
names = behaviors()
with scratch() as top, ThreadPoolExecutor(PROCESSES) as pool:
    jobs = [pool.submit(replayed, case(k, generator, names), Path(top) / str(k)) for k in range(LOGS)]
    problems = []
    for k, job in enumerate(jobs):
        problems += [job.result()] if job.result() else []
        progress(f"{k + 1} of {LOGS} logs")
    located, text = gain_located(Path(top))
    progress_done()
if problems:
    print("\n".join(problems), file=sys.stderr)
if not located:
    print(text, file=sys.stderr)
finish(f"{LOGS - len(problems)} of {LOGS} logs bit for bit, of {len(names)} behaviors; one bit of a gain "
       f"{'is' if located else 'is NOT'} located", not problems and located)
