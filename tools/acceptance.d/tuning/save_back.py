#!/usr/bin/env python3
"""Every live value of every behavior in library and examples is changed and saved: the files differ in values only, they
hold exactly what was asked for, and their run is, bit for bit, the run of the old file in which a scenario `set`s the
same values at 0 s, at once. The first states read values at their entry (`after: $beat`), before the first edit can be
applied: the files in BEFORE get their values from --set instead."""
import os
import random
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import FOOTFALL, PROCESSES, ROOT, SEED, finish, progress, progress_done, scratch

ROUNDS = int(os.environ.get("FOOTFALL_ROUNDS", "4"))  # rounds per file: the first half near the shipped values
BEFORE = ("examples/nod.yaml",)
FOLDERS = ("behaviors/library", "examples")
LIVE = re.compile(r"^\$?(\S+) .*(?:parameter|gain) (\[.*?\]|\S+), range (\S+) to ([^,]+), live", flags=re.M)
VALUE = re.compile(r"\b(value|kp|ki|kd): *(\[[^\]]*\]|\{[^}]*\}|[^,}\]\n#]+)")


def call(*arguments, good=(0,)):
    done = subprocess.run([FOOTFALL, *map(str, arguments)], cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True,
                          text=True, timeout=600)
    if done.returncode not in good:
        raise RuntimeError(f"exit {done.returncode} from {' '.join(map(str, arguments))}: {done.stderr.strip()[:300]}")
    return done.stdout


def is_behavior(path):
    return re.search(r"^(behavior|base):", path.read_text(encoding="utf-8"), flags=re.M) and path.name != "sweep.yaml"


def live_values(path):
    """(name, shipped values, least, most) of every live parameter and gain."""
    found = []
    for name, value, least, most in LIVE.findall(call("signals", path, good=(0, 2))):  # exit code 2: no parameters
        found.append((name, [float(x) for x in value.strip("[]").split(",")], float(least), float(most)))
    return found


def drawn(generator, near, shipped, least, most):
    """Values within the range: of many digits or few, apart or the same for all."""
    def one(old):
        number = old * generator.uniform(0.8, 1.2) if near else generator.uniform(least, most)
        return min(max(round(number, 3) if generator.random() < 0.5 else number, least), most)
    values = [one(x) for x in shipped]
    return values[:1] * len(values) if generator.random() < 0.3 else values


def blanked(path):
    return VALUE.sub(r"\1: VALUE", path.read_bytes().decode("utf-8"))


def without_edits(log):
    return [line for line in call("export", log, "--csv", "--events").splitlines() if ",edit," not in line]


def runs_differ(old, new, settings, top, seconds):
    """Empty if the two runs are equal, else their first difference."""
    scenario = top / "edited.yaml"
    script = ", ".join(f"{name}: {text}" for name, text in settings)
    scenario.write_text(f"scenario: 1\nbehavior: {old}\nworld: flat\nseeds: {SEED}..{SEED}\nfor: {seconds} s\n"
                        f"script:\n  - {{at: 0 s, set: {{{script}}}}}\n", encoding="utf-8")
    options = ("--no-report", "--quiet", "--log-all", "--seed", SEED)
    plain = (*options, "--for", f"{seconds}s", "--world", "flat")
    if str(old).endswith(BEFORE):
        call("run", old, *plain, *(x for name, text in settings for x in ("--set", f"{name}={text}")), "--log", top / "a",
             good=(0, 1))
    else:
        call("run", scenario, *options, "--log", top / "a", good=(0, 1))
    call("run", new, *plain, "--log", top / "b", good=(0, 1))
    text = call("diff", top / "a", top / "b", good=(0, 1))
    parted = re.findall(r"^(?:signal|command|input|plan) .*", text, flags=re.M)
    if not parted and without_edits(top / "a") != without_edits(top / "b"):
        parted = ["events"]
    return "; ".join(parted)[:300]


def fresh(tree):
    shutil.rmtree(tree, ignore_errors=True)
    for folder in FOLDERS:
        shutil.copytree(Path(ROOT, folder), tree / folder)


def saved(name, k, tree):
    """Saves new values into a fresh tree; far from the shipped ones only as `run` would begin with them."""
    generator = random.Random(f"{name} {k}")
    live = live_values(Path(ROOT, name))
    values = [(n, drawn(generator, 2 * k < ROUNDS, *rest)) for n, *rest in live]
    while values:
        fresh(tree)
        settings = [(n, f"[{', '.join(map(repr, v))}]" if len(v) > 1 else repr(v[0])) for n, v in values]
        call("set", tree / name, *(f"{n}={text}" for n, text in settings), "--yes")
        if "error:" not in subprocess.run([FOOTFALL, "check", str(tree / name)], cwd=ROOT, capture_output=True, text=True).stderr:
            return settings
        values = [(n, [(old + x) / 2 for old, x in zip(rest[0], v)]) for (n, *rest), (_, v) in zip(live, values)]
    return []


def problem_of(name, k, top):
    """Empty if one file with all its live values changed is correct, and their number."""
    fresh(top / "old")
    settings = saved(name, k, top / "new")
    if not settings:
        return "", 0
    for path in sorted(p for p in (top / "old").rglob("*") if p.is_file()):
        new = top / "new" / path.relative_to(top / "old")
        derived = path == top / "old" / name and re.search(r"^base:", path.read_text(encoding="utf-8"), flags=re.M)
        if blanked(path) != blanked(new) and not derived:  # what its base has is written as an override
            return f"{name}: {path.name} differs in more than values", 0
    again = call("set", top / "new" / name, *(f"{n}={text}" for n, text in settings), "--yes")
    if "has these values already" not in again:
        return f"{name}: read back, the values are others", 0
    if "robot:" not in call("config", top / "new" / name):
        return "", len(settings)
    parted = runs_differ(top / "old" / name, top / "new" / name, settings, top, 2 if 2 * k < ROUNDS else 0.5)
    return (f"{name}: the runs part: {parted}" if parted else ""), len(settings)


names = [f"{folder}/{path.name}" for folder in FOLDERS for path in sorted(Path(ROOT, folder).glob("*.yaml")) if is_behavior(path)]
problems, changed, total = [], 0, len(names) * ROUNDS
with scratch() as top, ThreadPoolExecutor(PROCESSES) as pool:
    jobs = [pool.submit(problem_of, name, k, Path(top) / f"{i}_{k}") for i, name in enumerate(names) for k in range(ROUNDS)]
    for k, job in enumerate(jobs):
        problem, count = job.result()
        problems += [problem] if problem else []
        changed += count
        progress(f"{k + 1} of {total} saves")
    progress_done()
if problems:
    print("\n".join(problems), file=sys.stderr)
finish(f"{total - len(problems)} of {total} saves of {len(names)} behaviors, {changed} values: only values differ, "
       "they read back bit for bit, the saved file runs as the edited run", not problems and changed > 0)
