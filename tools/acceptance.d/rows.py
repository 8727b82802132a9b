"""Shared by the acceptance rows: runs of `footfall` two at a time, runs of the benchmarks, and the final line.

A row is a small program: it measures, prints progress to stderr, then calls finish(), which prints `figure: ...` and
exits 0 or 1. If it cannot measure, it ends with an exception or with exit code 4.
"""
import json
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
BUILD = ROOT / "build" / "release"
FOOTFALL = os.environ.get("FOOTFALL", str(BUILD / "apps" / "footfall"))
BENCHES = Path(os.environ.get("FOOTFALL_BENCHES", BUILD / "tests" / "bench"))
WANT = bool(os.environ.get("ACCEPTANCE_WANT"))  # also measure what only the want bars need
BALANCE = "behaviors/library/balance.yaml"  # Tables I and II
BEST = "behaviors/library/balance_best.yaml"  # the tuned parameter set
PROCESSES = 2
SEED = 100  # first of the seeds for reported figures; smaller ones are for tuning


def finish(figure, passed, want=None):
    """Prints the row's figure, whether its want holds (None: not measured), and exits."""
    print(f"figure: {figure}")
    if want is not None:
        print(f"want: {'yes' if want else 'no'}")
    sys.exit(0 if passed else 1)


def give_up(text):
    print(f"figure: not measured: {text}")
    sys.exit(4)


def progress(text):
    if sys.stderr.isatty():
        print(f"\r\x1b[K  {text}", end="", file=sys.stderr, flush=True)


def progress_done():
    if sys.stderr.isatty():
        print("\r\x1b[K", end="", file=sys.stderr, flush=True)


def last_json(text):
    """The JSON object at the end of `text`."""
    lines = text.splitlines()
    for i in range(len(lines) - 1, -1, -1):
        if lines[i].startswith("{"):
            try:
                return json.loads("\n".join(lines[i:]))
            except json.JSONDecodeError:
                continue
    raise ValueError("no JSON object at the end of the output")


def run(behavior, *arguments, log=False, timeout=7200 if WANT else 900):
    """One `footfall run ... --json`; returns its object. A fall is a result; bad input or a hang is not."""
    command = [FOOTFALL, "run", behavior, "--json", "--quiet", "--no-report" if log else "--no-log", *map(str, arguments)]
    done = subprocess.run(command, cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          timeout=timeout)
    if done.returncode not in (0, 1):
        reason = (done.stderr.strip().splitlines() or ["no message"])[0]
        raise RuntimeError(f"exit {done.returncode} from {' '.join(command)}: {reason}")
    return last_json(done.stdout)


def run_all(cases, log=False):
    """Runs the cases, each (name, [behavior, arguments...]), two at a time; returns {name: object} in order."""
    results = {}
    with ThreadPoolExecutor(PROCESSES) as pool:
        futures = {pool.submit(run, *arguments, log=log): name for name, arguments in cases}
        try:
            for future in as_completed(futures):
                results[futures[future]] = future.result()
                progress(f"{len(results)} of {len(cases)} runs")
        except (OSError, RuntimeError, ValueError, subprocess.TimeoutExpired) as problem:  # one case that cannot run makes the figure meaningless
            pool.shutdown(wait=False, cancel_futures=True)
            progress_done()
            give_up(problem)
    progress_done()
    return {name: results[name] for name, _ in cases}


def bench(name, *arguments, timeout=600):
    """Runs a program of tests/bench alone on the machine; returns its JSON object."""
    program = BENCHES / name
    if not program.exists():
        give_up(f"{program} is not built")
    try:
        done = subprocess.run([str(program), *arguments], cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, timeout=timeout)
    except subprocess.TimeoutExpired:
        give_up(f"{name} took longer than {timeout} s")
    if done.returncode not in (0, 1):
        give_up(f"{name} ended with {done.returncode}: {done.stderr.strip()[-200:]}")
    try:
        return last_json(done.stdout)
    except ValueError as problem:
        give_up(f"{name}: {problem}")


def unit(program, test, timeout=600):
    """Runs one test of a program of tests/unit; returns (passed, its recorded properties)."""
    path = BUILD / "tests" / "unit" / program
    if not path.exists():
        give_up(f"{path} is not built")
    with scratch() as folder:
        report = Path(folder) / "report.json"
        subprocess.run([str(path), f"--gtest_filter={test}", f"--gtest_output=json:{report}"], cwd=ROOT,
                       stdin=subprocess.DEVNULL, capture_output=True, timeout=timeout)
        suites = json.loads(report.read_text())["testsuites"]
    if len(suites) != 1 or len(suites[0]["testsuite"]) != 1:
        give_up(f"{program} has no test {test}")
    case = suites[0]["testsuite"][0]
    return "failures" not in case, case


def pick(figures, *path):
    """figures[path[0]][path[1]]..., or exits with a clear message."""
    for key in path:
        if not isinstance(figures, dict) or figures.get(key) is None:
            give_up(f"no '{'.'.join(path)}' in the figures")
        figures = figures[key]
    return figures


def scratch():
    """A temporary directory, removed at the end."""
    return tempfile.TemporaryDirectory(prefix="footfall-acceptance-")
