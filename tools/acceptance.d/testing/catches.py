#!/usr/bin/env python3
"""Usage: tools/acceptance.d/testing/catches.py [NAME...] [--show]

Checks that the quick set detects mistakes in the library. Each planted mistake of tests/runs/regression/planted.json
is applied alone to a copy of the tree, built and judged by `footfall test --labels quick`; those of harmless.json change
nothing relevant and must pass. A mistake counts as caught if a scenario fails, and as well reported if the text of a
failed expectation, its state or its reason names one of the mistake's `points_at` (a signal, a state, a quantity).

  NAME...     only mistakes whose name contains one of these words
  --show      prints the reports of each
Exit: 0 at least nine of ten caught and well reported, none of the harmless ones reported; 1 otherwise; 2 bad usage; 4 the
set fails without any mistake.
"""
import argparse
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import rows  # noqa: E402

SET = rows.ROOT / "tests" / "runs" / "regression"
TREE = rows.ROOT / "build" / "planted" / "tree"
BUILD = TREE / "build" / "planted"
MUST = 0.9  # of the planted mistakes


def run(command, **options):
    return subprocess.run([str(c) for c in command], stdin=subprocess.DEVNULL, capture_output=True, text=True, **options)


def copy_tree():
    """Copies the tracked and changed files; their build is kept between calls."""
    TREE.mkdir(parents=True, exist_ok=True)
    names = run(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=rows.ROOT, check=True).stdout.split("\n")
    for name in filter(None, names):
        source, target = rows.ROOT / name, TREE / name
        if not source.is_file():
            continue
        if target.is_file() and target.read_bytes() == source.read_bytes():
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(source, target)


def build():
    environment = dict(os.environ, CCACHE_BASEDIR=str(TREE), CCACHE_NOHASHDIR="1")
    if not (BUILD / "build.ninja").exists():
        done = run(["cmake", "--preset", "release", "-B", BUILD, "-DFOOTFALL_BUILD_TESTS=OFF"], cwd=TREE, env=environment)
        if done.returncode:
            rows.give_up(done.stderr.strip().splitlines()[-1])
    done = run(["ninja", "-C", BUILD, "footfall"], env=environment)
    return done.returncode == 0, done.stdout


def apply(edits):
    """Replaces each text, which must occur exactly once; returns a function that restores the files."""
    before = {}
    for name, old, new in edits:
        path = TREE / name
        text = path.read_text(encoding="utf-8")
        before.setdefault(path, text)
        if text.count(old) != 1:
            put_back(before)
            rows.give_up(f"{name} holds the text to be replaced {text.count(old)} times: {old!r}")
        path.write_text(text.replace(old, new), encoding="utf-8")
    return before


def put_back(before):
    for path, text in before.items():
        path.write_text(text, encoding="utf-8")


def judge(out):
    """The failures of the quick set, one text for each failed expectation or run; empty if it passes."""
    result = out / "result.json"
    result.unlink(missing_ok=True)
    done = run([BUILD / "apps" / "footfall", "test", "tests/runs/regression", "--labels", "quick", "-j", rows.PROCESSES,
                "--out", out, "--json", result, "--no-report"], cwd=TREE, timeout=900)
    if done.returncode == 0:
        return []
    if not result.exists():
        return [f"exit {done.returncode}: {done.stderr.strip()[-300:]}"]
    texts = []
    for scenario in json.loads(result.read_text())["scenarios"]:
        for one in scenario["runs"]:
            broken = [e for e in one.get("expectations") or [] if not e["passed"]]
            texts += [f"{scenario['name']}: {e['text']} [{e['state']}] {e['why']}" for e in broken]
            texts += [f"{scenario['name']}: {f['kind']}: {f['text']}" for f in one["failures"]]
            if not broken and not one["failures"] and one["verdict"] != "passed":
                texts.append(f"{scenario['name']}: {one['verdict']}: {one['why']}")
        texts += [f"{scenario['name']}: {scenario['errors']}"] if scenario.get("errors") else []
    return texts or [f"exit {done.returncode}"]


def try_one(mistake, out):
    before = apply(mistake["edits"])
    try:
        built, text = build()
        if not built:
            rows.give_up(f"'{mistake['name']}' does not compile: {text[-600:]}")
        return judge(out)
    finally:
        put_back(before)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--show", action="store_true")
    arguments = parser.parse_args()
    wanted = lambda m: not arguments.names or any(n in m["name"] for n in arguments.names)  # noqa: E731
    planted = [m for m in json.loads((SET / "planted.json").read_text()) if wanted(m)]
    harmless = [m for m in json.loads((SET / "harmless.json").read_text()) if wanted(m)]
    copy_tree()
    built, text = build()
    if not built:
        rows.give_up(f"the tree does not build: {text[-600:]}")
    out = TREE / "out" / "planted"
    failures = judge(out)
    if failures:
        rows.give_up("the quick set fails without a mistake: " + failures[0])
    caught, pointed, alarms = [], [], []
    for mistake in planted + harmless:
        failures = try_one(mistake, out)
        named = [w for w in mistake.get("points_at", []) if any(w in line.split(': ', 1)[-1] for line in failures)]
        if mistake in harmless:
            alarms += [mistake["name"]] if failures else []
        else:
            caught += [mistake["name"]] if failures else []
            pointed += [mistake["name"]] if named else []
        print(f"{'caught' if failures else 'silent'}  {mistake['name']}: {', '.join(named)}", file=sys.stderr, flush=True)
        if arguments.show:
            print("\n".join("        " + line for line in failures[:12]), file=sys.stderr)
    build()  # restore the build for the next call
    missed = [m["name"] for m in planted if m["name"] not in pointed]
    figure = (f"{len(caught)} of {len(planted)} caught, {len(pointed)} at the right place"
              f"{' (not: ' + ', '.join(missed) + ')' if missed else ''}; {len(alarms)} of {len(harmless)} harmless edits reported")
    rows.finish(figure, len(pointed) >= MUST * len(planted) and not alarms, len(pointed) == len(planted))


if __name__ == "__main__":
    main()
