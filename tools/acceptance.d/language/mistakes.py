#!/usr/bin/env python3
"""Usage: tools/acceptance.d/language/mistakes.py [--count N] [--seed S] [--show]

One-token mistakes in the library's files and the examples: each must cause an error or at least a warning, and those
accepted without either must not change the robot's motion.

A mistake is one of: a letter of a word dropped, doubled, swapped with the next or replaced; a token dropped, doubled or
swapped with the next one; a unit replaced by another; a word replaced by another word of the file; a line indented by
one step more or less; a line of one key and its value dropped. Tokens are words, numbers with their unit, and punctuation, outside comments and
free text (`doc:`, `log:`, `reason:`, texts in `events:`). Kinds are drawn with equal probability, files in
proportion to their number of tokens.

Some such edits give another valid behavior that the author may have intended; no tool can detect them. They are not
drawn. meaning.py decides from the file alone, never from Footfall's output; these are all of them:
  - edits that do not change the YAML tree;
  - a number for a number: another unit of the same dimension (in `at:` also a time for a part);
  - a word for another of the same kind, if all of them are valid: a state in `to`, `initial`, `default`
    or `safe`; a stack in `stack` or `toward`; a gain table in `gains`; an axis of the same type of task; a shape of
    trajectory; `true` for `false`; an operand of an expression for one of the same dimension; another name of a mark;
  - a name that nothing else in the file refers to, for another name: a state, an internal force; a task that a state
    overrides in its stack for another task of the file;
  - an optional entry removed as a whole: a state without references, a state's override of its stack's tasks,
    one of several transitions or actions, one of the keys in meaning.OPTIONAL, and anything in a file with `base:`
    (then the base's value applies).

An accepted mistake is compared with the original: `footfall trace` with a script, and `footfall run` of 4 s in MuJoCo.

  --count N   number of mistakes (1000)
  --seed S    seed of the random mistakes (100; smaller ones are for tuning)
  --least P   minimum percentage refused or warned about (97); below that nothing is compared
  --show      prints each accepted mistake
Exit: 0 at least 97 % are refused or warned about and no accepted one changes anything, 1 otherwise, 2 bad usage.
"""
import argparse
import random
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
sys.path.insert(0, str(Path(__file__).resolve().parent))
import rows  # noqa: E402
from meaning import Meaning  # noqa: E402
from mutations import Mutator  # noqa: E402

FILES = sorted([*rows.ROOT.glob("behaviors/library/*.yaml"), *rows.ROOT.glob("examples/*.yaml")])
MUST, WANT = 97.0, 99.0  # per cent
SCRIPT = "[{after: 200 ms}, {event: start}, {after: 3 s}, {event: contact.left_foot.touchdown}, {after: 5 s}]\n"


def footfall(*arguments):
    return subprocess.run([rows.FOOTFALL, *map(str, arguments)], cwd=rows.ROOT, stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, timeout=120)


def draw(count, rng, folder):
    """`count` mistakes as (original, mutation, path of the mutated copy); copies the files of `base:` and `scripts:`."""
    for file in [*FILES, *(lua for file in FILES for lua in file.parent.glob("*.lua"))]:
        copy = folder / file.relative_to(rows.ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(file, copy)
    files = [(file, Mutator(file.read_text(encoding="utf-8"))) for file in FILES]
    meanings = {file: Meaning(mutator) for file, mutator in files}
    drawn, seen = [], set()
    while len(drawn) < count:
        file, mutator = rng.choices(files, [len(m.tokens) for _, m in files])[0]
        mutation = mutator.draw(rng)
        if mutation.text in seen or meanings[file].may_be_meant(mutation):
            continue
        seen.add(mutation.text)
        path = (folder / file.relative_to(rows.ROOT)).with_name(f"mutant_{len(drawn)}.yaml")
        path.write_text(mutation.text, encoding="utf-8")
        drawn.append((file, mutation, path))
    return drawn


def verdict(path):
    """'refused', 'warned' or 'accepted'; anything but a message and exit 2 or 0 is an exception."""
    done = footfall("check", path)
    if done.returncode == 2:
        return "refused"
    if done.returncode != 0:
        raise RuntimeError(f"exit {done.returncode}: {done.stderr[-300:]}")
    return "warned" if " warning: " in done.stderr else "accepted"


def deeds(path, script):
    """The behavior's effects: its trace, and the figures of a short run without wall-clock times."""
    trace = footfall("trace", path, "--script", script)
    run = footfall("run", path, "--for", "4s", "--json", "--quiet", "--no-log")
    figures = re.sub(r'"(tick_us|real_time_factor|allocations|behavior)":(\{[^}]*\}|[^,}]*)', "", run.stdout)
    return trace.returncode, trace.stdout, run.returncode, figures


def report(drawn, verdicts, changed, show, least):
    counts = {v: verdicts.count(v) for v in ("refused", "warned", "accepted")}
    if show:
        for (file, mutation, _), word in zip(drawn, verdicts):
            if word == "accepted":
                line = file.read_text(encoding="utf-8").split("\n")[mutation.line].strip()
                mark = "changes " if mutation in changed else "accepted"
                print(f"{mark} {file.name}:{mutation.line + 1} {mutation.kind}: {mutation.what}   | {line[:90]}")
    noticed = 100 * (counts["refused"] + counts["warned"]) / len(drawn)
    rows.finish(f"{len(drawn)} mistakes: {counts['refused']} refused, {counts['warned']} warned about "
                f"({noticed:.1f} %), {counts['accepted']} accepted, of which {len(changed)} change what it does",
                noticed >= least and not changed, want=noticed >= WANT and not changed)


def main():
    parser = argparse.ArgumentParser(add_help=False)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=rows.SEED)
    parser.add_argument("--least", type=float, default=MUST)
    parser.add_argument("--show", action="store_true")
    parser.add_argument("-h", "--help", action="store_true")
    options = parser.parse_args()
    if options.help:
        print(__doc__)
        return
    cases = rows.BUILD / "tests" / "language" / "mistakes" / "mistakes_test"
    if options.count >= 1000 and subprocess.run([cases], stdout=subprocess.DEVNULL).returncode:
        rows.finish("the cases of tests/language/mistakes are not reported as they say", False)
    with tempfile.TemporaryDirectory() as name, ThreadPoolExecutor(rows.PROCESSES) as pool:
        folder = Path(name)
        script = folder / "script.yaml"
        script.write_text(SCRIPT, encoding="utf-8")
        drawn = draw(options.count, random.Random(options.seed), folder)
        verdicts = list(pool.map(lambda d: verdict(d[2]), drawn))
        accepted = [d for d, v in zip(drawn, verdicts) if v == "accepted" and options.least >= MUST]
        originals = {f: pool.submit(deeds, f, script) for f in {f for f, _, _ in accepted}}
        results = list(pool.map(lambda d: deeds(d[2], script), accepted))
        changed = [d[1] for d, r in zip(accepted, results) if r != originals[d[0]].result()]
    report(drawn, verdicts, changed, options.show, options.least)


if __name__ == "__main__":
    main()
