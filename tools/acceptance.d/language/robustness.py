#!/usr/bin/env python3
"""Robustness: coverage-guided fuzzing under ASan and UBSan, then hostile files and the largest findings in release."""
import os
import re
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import FOOTFALL, ROOT, WANT, finish, give_up, progress, progress_done

sys.path.insert(0, str(ROOT / "tests" / "language" / "fuzz"))

import hostile_files
import make_corpus

SECONDS = int(os.environ.get("FOOTFALL_FUZZ_SECONDS", 3600 if WANT else 600))
SHARES = {"behavior": 0.6, "expression": 0.15, "robot": 0.25}  # of the total time
LONGEST = {"behavior": 8192, "expression": 512, "robot": 8192}  # bytes, limit of an input
REPLAYED = 200  # number of the largest findings replayed with the release build
FOLDER = ROOT / "out" / "fuzz"


def build():
    for step in (["cmake", "--preset", "fuzz"], ["cmake", "--build", "--preset", "fuzz"]):
        done = subprocess.run(step, cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if done.returncode:
            give_up(f"{' '.join(step)} failed (clang and libclang-rt-14-dev are needed): {done.stdout[-300:]}")


def fuzz(target, seconds):
    """Runs one fuzzer; (executions, edges and features covered, findings)."""
    folder = FOLDER / target
    finds = FOLDER / f"{target}-finds"
    finds.mkdir(parents=True, exist_ok=True)
    command = [str(ROOT / "build" / "fuzz" / "tests" / "language" / "fuzz" / f"fuzz_{target}"), str(folder),
               f"-dict={FOLDER / 'words.dict'}", f"-max_total_time={int(seconds)}", f"-max_len={LONGEST[target]}",
               "-timeout=1", "-rss_limit_mb=1024", "-malloc_limit_mb=200", "-print_final_stats=1",
               f"-artifact_prefix={finds}/"]
    before = set(finds.iterdir())
    done = subprocess.run(command, cwd=FOLDER, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True, errors="replace", timeout=seconds + 300,
                          env=dict(os.environ, UBSAN_OPTIONS="halt_on_error=1:print_stacktrace=1"))
    (FOLDER / f"{target}.log").write_text(done.stderr, encoding="utf-8")
    executions = re.search(r"number_of_executed_units: (\d+)", done.stderr)
    coverage = re.findall(r"cov: (\d+) ft: (\d+)", done.stderr)
    found = sorted(str(f.relative_to(ROOT)) for f in set(finds.iterdir()) - before)
    if done.returncode and not found:
        found = [f"{target} ended with {done.returncode}"]
    return int(executions[1]) if executions else 0, coverage[-1] if coverage else ("0", "0"), found


def replay():
    """Runs the release build on the largest findings: (how many, problems, longest time, largest memory)."""
    files = sorted((FOLDER / "behavior").iterdir(), key=lambda f: f.stat().st_size, reverse=True)[:REPLAYED]
    problems, longest, largest = [], 0.0, 0.0
    for file in files:
        problem, seconds, peak = hostile_files.judge(FOOTFALL, file)
        longest, largest = max(longest, seconds), max(largest, peak)
        good = problem == "exit 0" and seconds <= hostile_files.SECONDS and peak <= hostile_files.MEGABYTES
        if problem and not good:  # a finding may be a valid behavior
            problems.append(f"{file.name}: {problem}, {seconds:.2f} s, {peak:.0f} MB")
    return len(files), problems, longest, largest


if not Path(FOOTFALL).exists():
    give_up(f"{FOOTFALL} is not built")
build()
make_corpus.make(FOLDER)
begin = time.monotonic()
figures, findings = [], []
for name, share in SHARES.items():
    progress(f"{name}, {share * SECONDS:.0f} s")
    executed, covered, found = fuzz(name, share * SECONDS)
    figures.append(f"{name} {executed} executions, {covered[0]} edges")
    findings += found
spent = time.monotonic() - begin
progress("hostile files")
bad, files, slowest, biggest = hostile_files.check_all(FOOTFALL)
count, replayed, longest, largest = replay()
progress_done()
problems = findings + bad + replayed
finish(f"{spent / 60:.0f} min: {', '.join(figures)}; {len(findings)} findings; {files - len(bad)} of {files} hostile files end with an error, "
       f"at most {slowest:.2f} s and {biggest:.0f} MB; {count} finds in the release at most {longest:.2f} s and "
       f"{largest:.0f} MB" + "".join(f"; {p}" for p in problems), not problems and spent >= 0.95 * min(SECONDS, 600), not problems and spent >= 3400)
