#!/usr/bin/env python3
"""Hostile Lua (tests/silent/hostile_scripts.py), each text in three ways: `check` of a file that runs it at load; a run as fast
as it goes, and for every second one a paced run, with the text at load, in a function called at each step, in a handler or in
a scenario. What does not end by itself gets TERM: it ends within 2 s with a declared exit code, its log is whole, and no tick
has allocated. Then pairs of paced runs with and without a script: the script brings no more late ticks.

`--quick N` takes N texts and two pairs, `--only TEXT` those whose name has it, `--pairs N` that many pairs (0: none);
`--list` prints each case that failed."""
import argparse
import json
import math
import os
import shutil
import signal
import statistics
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from rows import FOOTFALL, PROCESSES, ROOT, finish, last_json, progress, progress_done, scratch

sys.path.insert(0, str(ROOT / "tests" / "silent"))
from hostile_scripts import SCRIPTS

PROGRAM = str(Path(FOOTFALL).resolve())
AT_WORK = 0.9  # s until TERM: the function is called after 0.4 s of the run, and at each step
END_WITHIN = 2.0  # s after TERM
CHECK_WITHIN = 12.0  # s; of processor time its own limit is 4
PACED = 3  # s of each paced run of a pair
QUIET = 0.15  # share of the processors that others may use before a pair
PATIENCE = 300  # s that all pairs may take
UNKIND = ["terminate called", "PANIC", "Traceback", "AddressSanitizer"]
PLACES = ("entry", "handler", "load", "scenario")
# Loops that go on all the time, each of another kind: within the limit, in C, and in memory.
BUSY = ("endless loop: while", "errors swallowed: pcall(error)", "pattern: find .-.-.-.-b$", "memory: garbage", "coroutine: yields for ever",
        "work in C: rep of nothing")

HEAD = 'base: balance_best\nevents: {go: "for handlers"}\n'
CALLS = "templates: {stride: {states: {dual: {on_entry+: [{call: f}]}}}}\n"
RAISES = "templates: {stride: {states: {dual: {on_entry+: [{raise: go}]}}}}\n"
SCENARIO = """scenario: 1
behavior: mine.yaml
for: 1000 s
scripts: mine.lua
script: [{at: 300 ms, call: f}, {at: 600 ms, call: f}, {at: 900 ms, call: f}]
expect: [{never: "com.pos.z < 0.1 m"}]
"""


def write(folder, place, text, is_file=False):
    """The files of a case; returns the one to run."""
    lua = text if is_file or place == "load" else f"function f() {text} end"
    if place == "handler" and not is_file:
        lua += "\nfootfall.on('go', f)"
    (folder / "mine.lua").write_bytes(lua.encode("latin-1"))
    if place == "scenario":
        (folder / "mine.yaml").write_text(HEAD)
        (folder / "run.yaml").write_text(SCENARIO)
        return "run.yaml"
    calls = RAISES if is_file or place == "handler" else CALLS if place == "entry" else ""
    (folder / "mine.yaml").write_text(HEAD + "scripts: mine.lua\n" + calls)
    return "mine.yaml"


def ended(arguments, folder, at_work, limit):
    """(exit code or None, seconds to the end after TERM, stdout, stderr) of a command that gets TERM if it goes on for longer."""
    with open(folder / "out", "w+b") as out, open(folder / "err", "w+b") as err:
        process = subprocess.Popen([PROGRAM, *arguments], cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=err,
                                   start_new_session=True)
        begin = time.monotonic()
        try:
            process.wait(at_work)
        except subprocess.TimeoutExpired:
            begin = time.monotonic()
            process.send_signal(signal.SIGTERM)
            try:
                process.wait(limit)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
                return None, limit, "", ""
        took = time.monotonic() - begin
        out.seek(0)
        err.seek(0)
        return process.returncode, took, out.read().decode("utf-8", "replace"), err.read().decode("utf-8", "replace")


def log_problem(folder, verify):
    told = subprocess.run([PROGRAM, "events", "log", "--json"], cwd=folder, capture_output=True, timeout=60)
    if told.returncode:
        return "log cannot be read: " + told.stderr.decode("utf-8", "replace").strip()[-200:]
    if told.stderr:
        return "log is not whole: " + told.stderr.decode("utf-8", "replace").strip()[-200:]
    events = [json.loads(line) for line in told.stdout.decode("utf-8").splitlines()]
    if not events or events[-1]["kind"] != "end":
        return "log does not tell the end"
    if verify:
        done = subprocess.run([PROGRAM, "replay", "log", "--verify"], cwd=folder, capture_output=True, text=True, timeout=120)
        if done.returncode:
            return "replay: " + (done.stdout + done.stderr).strip()[-200:]
    return None


def judge_run(folder, file, options, codes, verify=False):
    arguments = ["run", file, "--log", "log", "--no-report", "--quiet", "--json", *options]
    code, took, out, err = ended(arguments, folder, AT_WORK, 4 * END_WITHIN)
    if code is None or took > END_WITHIN:
        return "does not end" if code is None else f"ends {took:.1f} s after TERM"
    if code not in codes:
        return f"exit code {code}, not {sorted(codes)}: {err.strip()[-300:]}"
    unkind = [text for text in UNKIND if text in err]
    if unkind:
        return f"says {unkind[0]!r}"
    if code in (-signal.SIGTERM, 2):
        return None  # it had not begun
    if code == 3:
        return None if "cannot write" in err else f"exit code 3: {err.strip()[-300:]}"
    allocations = last_json(out)
    allocations = allocations.get("figures", allocations).get("allocations")
    if allocations not in (0, None):
        return f"{allocations} allocations in ticks"
    return log_problem(folder, verify)


def judge_check(folder, file, *_):
    code, took, _, err = ended(["check", file], folder, CHECK_WITHIN, 1)
    if took > CHECK_WITHIN or code is None:
        return f"does not end within {CHECK_WITHIN:.0f} s"
    if code not in (0, 1, 2):
        return f"exit code {code}: {err.strip()[-300:]}"
    return None


def cases_of(number, script):
    """(what, place, judge, arguments) of a text."""
    name, _, where = script
    permission = [] if where in ("function", "file") else ["--allow", where]
    yield "check", "load", judge_check, ()
    for paced in (False, True) if number % 2 == 0 else (False,):
        place = PLACES[(number // 2 + paced) % (3 if paced or permission else 4)]
        if where == "file":
            place = "handler"
        # Before a run has begun, at load, TERM ends the command as it ends any other.
        codes = {0, 1} if place in ("entry", "handler") and where != "file" else {0, 1, 2, -signal.SIGTERM}
        if where == "files":
            codes |= {3}  # it may take every descriptor, so that the summary cannot be written
        options = [*permission, *(["--realtime"] if paced else [])]
        if place != "scenario":
            options += ["--for", "1000s"]
        yield "paced" if paced else "run", place, judge_run, (options, codes, number % 4 == 1)


def run_case(job):
    folder, script, (what, place, judge, arguments) = job
    folder.mkdir()
    file = write(folder, place, script[1], script[2] == "file")
    try:
        problem = judge(folder, file, *arguments)
    except (subprocess.TimeoutExpired, ValueError, UnicodeDecodeError) as trouble:
        problem = f"{type(trouble).__name__}: {trouble}"
    shutil.rmtree(folder)
    return f"{script[0]}, {what} at {place}: {problem}" if problem else None


def late_ticks(folder, behavior, before):
    done = subprocess.run([PROGRAM, "run", behavior, "--realtime", "--for", f"{PACED}s", "--no-log", "--quiet", "--json"], cwd=folder,
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60, preexec_fn=before)
    figures = last_json(done.stdout)
    return figures["faults"].get("tick.overrun", 0) / figures["time_s"]


def by_chance(worse, of):
    """Probability that so many of the pairs, or more, are worse if nothing makes them so."""
    return sum(math.comb(of, k) for k in range(worse, of + 1)) / 2**of


def before_others():
    """In a new process: a session whose share of the processors others do not cut. Linux shares out by session first, so under
    load everything that a process does more, a script's loop too, makes its own tick wait, whatever its thread's priority."""
    os.setsid()
    Path("/proc/self/autogroup").write_text("-19")


def may_go_before_others():
    try:
        return subprocess.run(["true"], preexec_fn=before_others).returncode == 0
    except subprocess.SubprocessError:
        return False


def busy():
    """Share of all processors that others use, over half a second."""
    def times():
        values = [int(v) for v in Path("/proc/stat").read_text().split("\n", 1)[0].split()[1:9]]
        return sum(values), values[3] + values[4]  # idle, waiting
    (all_before, idle_before), _, (all_after, idle_after) = times(), time.sleep(0.5), times()
    return 1 - (idle_after - idle_before) / max(1, all_after - all_before)


def wait_for_quiet(until):
    """Whether the machine came to rest by then."""
    while busy() > QUIET:
        progress("waits for an idle machine")
        if time.monotonic() > until:
            return False
        time.sleep(1)
    return True


def paced_pairs(folder, count):
    """Late ticks a second (with, without), the runs of a pair in turn; fewer pairs if others disturb and the machine has no rest."""
    before = before_others if may_go_before_others() else None
    texts = {name: text for name, text, _ in SCRIPTS}
    (folder / "plain.yaml").write_text(HEAD)
    found, until = [], time.monotonic() + PATIENCE
    for number in range(count):
        progress(f"{number} of {count} pairs")
        if before is None and not wait_for_quiet(until):
            break
        file = write(folder, "entry", texts[BUSY[number % len(BUSY)]])
        order = (file, "plain.yaml") if number % 2 else ("plain.yaml", file)
        rates = {name: late_ticks(folder, name, before) for name in order}
        found.append((rates[file], rates["plain.yaml"]))
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", type=int)
    parser.add_argument("--only", default="")
    parser.add_argument("--pairs", type=int)
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args()
    scripts = [(n, s) for n, s in enumerate(SCRIPTS) if options.only in s[0]]
    if options.quick:
        scripts = scripts[:: max(1, len(scripts) // options.quick)][: options.quick]
    count = options.pairs if options.pairs is not None else 2 if options.quick else 18
    failures = []
    with scratch() as name, ThreadPoolExecutor(PROCESSES) as pool:
        folder = Path(name)
        jobs = [(folder / f"{number}-{k}", script, case) for number, script in scripts
                for k, case in enumerate(cases_of(number, script))]
        for done, problem in enumerate(pool.map(run_case, jobs), 1):
            progress(f"{done} of {len(jobs)} cases")
            if problem:
                failures.append(problem)
                if options.list:
                    progress_done()
                    print(problem, flush=True)
        pairs = paced_pairs(folder, count)
    progress_done()
    worse, better = sum(w > p for w, p in pairs), sum(w < p for w, p in pairs)
    quiet = by_chance(worse, worse + better) > 0.05
    late = "not paced" if not count else f"the machine had no rest for {count} pairs, only for {len(pairs)}" if len(pairs) < count else (
        f"late ticks {statistics.median(w for w, _ in pairs):.1f} a second with scripts, {statistics.median(p for _, p in pairs):.1f} without "
        f"(medians of {len(pairs)} pairs; {worse} worse, {better} better)")
    whole = len(scripts) >= 200 and count or options.quick or options.only
    finish(f"{len(scripts)} scripts, {len(jobs) - len(failures)} of {len(jobs)} cases as they should; {late}",
           bool(whole) and not failures and quiet and len(pairs) == count)


main()
