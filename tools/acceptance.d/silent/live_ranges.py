#!/usr/bin/env python3
"""Live ranges are true: each live parameter of each library behavior at both ends of its range and at random points within,
edited while the robot steps on `flat`: no edit is refused, nobody falls. `--behavior NAME`, `--seeds FIRST COUNT`,
`--points N` narrow it; `--list` prints each case that failed."""
import argparse
import random
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import FOOTFALL, PROCESSES, ROOT, SEED, finish, last_json, progress, progress_done, scratch

LIVE = re.compile(r"^\$(\S+) .*parameter (\[.*?\]|\S+), range (\S+) to ([^,:]+), live", flags=re.M)
AT_STEP, SECONDS = 10, 14  # the edit comes in full stride; then some 20 steps more


def call(*arguments):
    return subprocess.run([FOOTFALL, *map(str, arguments)], cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          timeout=600)


def cases(behavior, points, generator):
    """(parameter, values): both ends and random points; of a vector each component is drawn."""
    for name, values, least, most in LIVE.findall(call("signals", behavior).stdout):
        size = len(values.strip("[]").split(","))
        least, most = float(least), float(most)
        yield from ((name, [end] * size) for end in (least, most))
        for _ in range(points):
            yield name, [generator.uniform(least, most) for _ in range(size)]


def survives(folder, number, behavior, name, values, seed):
    """None, or what happened instead."""
    file = folder / f"case_{number}_{seed}.yaml"
    text = repr(values[0]) if len(values) == 1 else "[" + ", ".join(map(repr, values)) + "]"
    file.write_text(f"scenario: 1\nbehavior: {behavior}\nworld: flat\nfor: {SECONDS} s\n"
                    f"script: [{{at: {{step: {AT_STEP}}}, edit: {{{name}: {text}}}}}]\nexpect: [{{never: in(limp)}}]\n")
    done = call("run", file, "--seed", seed, "--json", "--quiet", "--no-log")
    if done.returncode not in (0, 1):
        return f"{name} = {text}: " + (done.stderr.strip().splitlines() or ["no message"])[0]
    if done.returncode == 0:
        return None
    return f"{name} = {text}, seed {seed}: " + str(last_json(done.stdout).get("end", "failed"))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--behavior", action="append")
    parser.add_argument("--seeds", nargs=2, type=int, default=(SEED, 3), metavar=("FIRST", "COUNT"))
    parser.add_argument("--points", type=int, default=8)
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args()
    behaviors = options.behavior or sorted(p.stem for p in (ROOT / "behaviors/library").glob("*.yaml"))
    seeds = range(options.seeds[0], options.seeds[0] + options.seeds[1])
    work = [(behavior, name, values, seed) for behavior in behaviors
            for name, values in cases(behavior, options.points, random.Random(4)) for seed in seeds]
    failures, done = [], 0
    with scratch() as folder, ThreadPoolExecutor(PROCESSES) as pool:
        for behavior, failure in pool.map(lambda job: (job[1][0], survives(Path(folder), job[0], *job[1])), enumerate(work)):
            done += 1
            progress(f"{done} of {len(work)} edits")
            if failure:
                failures.append(f"{behavior}: {failure}")
    progress_done()
    if options.list:
        print("\n".join(failures))
    finish(f"{len(work) - len(failures)} of {len(work)} edits within the ranges survived", bool(work) and not failures)


main()
