#!/usr/bin/env python3
"""Every command under everything that shells and machines do to it: closed streams, full disks, read-only folders, no HOME,
TMPDIR gone, signals, a pipe without reader, a second copy. Exit codes are the declared ones; files are whole or not there,
logs readable up to the failure. `--quick`: one command of each kind."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import os
import resource
import shutil
import signal
import subprocess
import time

from rows import FOOTFALL, ROOT, finish, progress, progress_done, scratch

QUICK = "--quick" in sys.argv[1:]
PROGRAM = str(Path(FOOTFALL).resolve())
SQUAT, NOD, BALANCE = (str(ROOT / p) for p in ("examples/squat.yaml", "examples/nod.yaml", "behaviors/library/balance.yaml"))
# Somebody without rights: permissions do not hold root back.
NOBODY = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"] if os.geteuid() == 0 else []


class Command:
    """`ends`: how long it takes by itself, `short` or `long`. `writes`: files that must be whole or not there."""

    def __init__(self, name, arguments, good=0, ends="short", writes=(), temporary=False):
        self.name, self.arguments, self.good, self.ends = name, arguments, good, ends
        self.writes, self.temporary = writes, temporary


LONG_SCENARIO = f"scenario: 1\nbehavior: {BALANCE}\nfor: 500 s\nexpect: [{{never: \"com.pos.z < 0.1 m\"}}]\n"
SHORT_SCENARIO = f"scenario: 1\nbehavior: {SQUAT}\nfor: 2 s\nexpect: [{{end: finished}}]\n"

SHORT = [
    Command("run", ["run", SQUAT, "--log", "run", "--no-report"], writes=["run/summary.json", "run/timing.json"]),
    Command("run report", ["run", SQUAT, "--log", "run2"], writes=["run2/summary.json", "run2/report.html"], temporary=True),
    Command("run scenario", ["run", "short.yaml", "--log", "run3", "--no-report"], writes=["run3/result.json"]),
    Command("test", ["test", "short.yaml", "--out", "test"], writes=["test/session.json"]),
    Command("sweep", ["sweep", SQUAT, "--seeds", "1..2", "--for", "1s", "--out", "sweep"]),
    Command("check", ["check", SQUAT]),
    Command("trace", ["trace", NOD, "--events", "enough"]),
    Command("signals", ["signals", SQUAT]),
    Command("graph", ["graph", SQUAT, "--format", "dot"]),
    Command("graph file", ["graph", SQUAT, "--format", "dot", "-o", "graph.dot"], writes=["graph.dot"]),
    Command("schema", ["schema", "behavior"]),
    Command("reference", ["reference"]),
    Command("fmt", ["fmt", "--stdout", SQUAT]),
    Command("fmt file", ["fmt", "ugly.yaml"], writes=["ugly.yaml"]),
    Command("config", ["config", SQUAT]),
    Command("set", ["set", "mine.yaml", "depth=5cm", "--yes"], writes=["mine.yaml"]),
    Command("new", ["new", "behavior", "fresh"], writes=["fresh.yaml"]),
    Command("report", ["report", "log", "-o", "page.html"], writes=["page.html"]),
    Command("runs", ["runs", "list", "--in", "."]),
    Command("events", ["events", "log"]),
    Command("replay", ["replay", "log", "--verify"], temporary=True),
    Command("diff", ["diff", "log", "log"]),
    Command("why", ["why", "log", "--at", "0.5s"], temporary=True),
    Command("export", ["export", "log", "--csv"]),
    Command("tune key", ["tune", "key", "my.key"], writes=["my.key"]),
    Command("tune", ["tune", "list", "--url", "udpm://239.255.76.67:7999?ttl=0", "--timeout", "100ms", "--open"], good=3),
]
LONG = [
    Command("run", ["run", BALANCE, "--for", "500s", "--realtime", "--log", "run", "--no-report"], ends="long"),
    Command("run lock-step", ["run", BALANCE, "--for", "5000s", "--log", "run", "--no-report"], ends="long"),
    Command("run scenario", ["run", "long.yaml", "--log", "run", "--no-report"], ends="long"),
    Command("test", ["test", "long.yaml", "--out", "test"], ends="long"),
    Command("sweep", ["sweep", BALANCE, "--seeds", "1..2", "--for", "500s", "--out", "sweep"], ends="long"),
]
if QUICK:
    SHORT = [c for c in SHORT if c.name in ("run", "check", "fmt file", "export", "replay", "new")]
    LONG = [c for c in LONG if c.name in ("run", "test")]

failures, tried = [], 0


def fail(command, condition, text):
    failures.append(f"{command.name}, {condition}: {text}")


def prepare(folder):
    """A fresh folder with what the commands read."""
    shutil.copytree(PREPARED, folder, symlinks=True)
    for path in [folder, *folder.rglob("*")]:
        if NOBODY:
            os.chown(path, 65534, 65534)
    return folder


def run(command, folder, condition, codes, environment=None, before=None, **how):
    """Runs it and judges code, words and files. Returns what it said on stderr."""
    global tried
    tried += 1
    variables = {**os.environ, "HOME": str(folder), "TMPDIR": str(folder), **(environment or {})}
    for name in [n for n, v in variables.items() if v is None]:
        del variables[name]
    how = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **how}
    try:
        done = subprocess.run(NOBODY + [PROGRAM, *command.arguments], cwd=folder, env=variables, timeout=120, preexec_fn=before, **how)
    except subprocess.TimeoutExpired:
        fail(command, condition, "hangs")
        return ""
    said = (done.stderr or b"").decode("utf-8", "replace")
    if done.returncode not in codes:
        fail(command, condition, f"exit code {done.returncode}, not {sorted(codes)}: {said.strip()[-200:]}")
    if "Traceback" in said or "terminate called" in said or "filesystem error" in said:
        fail(command, condition, f"no words for people: {said.strip()[-200:]}")
    if done.returncode == 3 and command.good != 3 and said.count("\n") > 3 and command.name not in ("test", "sweep"):
        fail(command, condition, f"more than one line for one trouble: {said.strip()[-300:]}")
    whole_files(command, folder, condition)
    return said


def whole_files(command, folder, condition):
    for name in command.writes:
        path = folder / name
        if not path.exists():
            continue
        text = path.read_bytes()
        closed = {".json": text.rstrip().endswith(b"}"), ".html": text.rstrip().endswith(b"</html>"), ".yaml": text.endswith(b"\n"),
                  ".dot": text.rstrip().endswith(b"}"), ".key": len(text) == 65}
        if not closed[path.suffix]:
            fail(command, condition, f"{name} is not whole")
    left = [str(p.relative_to(folder)) for p in folder.rglob("*.part")]
    if left:
        fail(command, condition, f"left behind: {left}")
    for log in folder.glob("run*/log.mcap"):
        told = subprocess.run([PROGRAM, "events", str(log)], capture_output=True, timeout=60)
        if log.stat().st_size and told.returncode != 0:
            fail(command, condition, f"its log cannot be read: {told.stderr.decode()[-200:]}")


def close(number):
    return lambda: os.close(number)


def small_files(size):
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


def short_ones(scratch_folder):
    for number, command in enumerate(SHORT):
        progress(f"{number} of {len(SHORT)} commands: {command.name}")

        def fresh(name):
            return prepare(scratch_folder / f"{number}-{name}")

        good = {command.good}
        run(command, fresh("plain"), "plain", good)
        for stream in (0, 1, 2):
            how = {"stdin": None} if stream == 0 else {}
            folder = fresh(f"closed{stream}")
            pipes = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
            run(command, folder, f"descriptor {stream} closed", good, before=close(stream), **how, **pipes)
        with open("/dev/full", "wb") as full:
            run(command, fresh("full"), "stdout on a full disk", good | {3}, stdout=full)
            run(command, fresh("full2"), "stderr on a full disk", good, stderr=full)
        reader, writer = os.pipe()
        os.close(reader)
        run(command, fresh("pipe"), "a pipe without reader", good, stdout=writer)
        os.close(writer)
        folder = fresh("small")
        code = {3} if command.writes or command.name == "sweep" else good | {3}
        run(command, folder, "files full", code | (good if command.name in ("new", "set", "tune key", "fmt file", "graph file") else set()), before=small_files(200_000 if command.name.startswith("run") else 3000))
        folder = fresh("readonly")
        for path in [*folder.rglob("*"), folder]:
            if path.is_dir():
                path.chmod(0o555)
        run(command, folder, "a read-only folder", {3} if command.writes or command.name == "sweep" or command.temporary else good | {3})
        for path in [folder, *folder.rglob("*")]:
            if path.is_dir():
                path.chmod(0o755)
        run(command, fresh("nohome"), "no HOME", good, environment={"HOME": None})
        run(command, fresh("notmp"), "TMPDIR gone", {3} if command.temporary and command.name != "run report" else good | {3}, environment={"TMPDIR": "/nowhere"})


def begin(command, folder, **how):
    environment = dict(os.environ, HOME=str(folder), TMPDIR=str(folder))
    return subprocess.Popen(NOBODY + [PROGRAM, *command.arguments], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True, **how)


def at_work(process, command, folder):
    """Waits until it has begun to write."""
    for _ in range(400):
        if any(folder.glob("run/log.mcap")) or any(folder.glob("test/**/log.mcap")) or any(folder.glob("sweep/sweep.sqlite")):
            time.sleep(0.4)
            return
        if process.poll() is not None:
            break
        time.sleep(0.02)
    fail(command, "start", f"did not begin: {process.stderr.read().decode()[-200:]}")


def children_of(group):
    found = subprocess.run(["pgrep", "-f", str(group)], capture_output=True, text=True)
    return found.stdout.split()


def stop(command, folder, numbers, codes, condition):
    global tried
    tried += 1
    process = begin(command, folder)
    at_work(process, command, folder)
    sent = time.monotonic()
    for number in numbers:
        process.send_signal(number)
        time.sleep(0.05)
    try:
        process.communicate(timeout=8)
    except subprocess.TimeoutExpired:
        process.kill()
        fail(command, condition, "does not end")
        return
    took = time.monotonic() - sent
    if process.returncode not in codes:
        fail(command, condition, f"exit code {process.returncode}, not {sorted(codes)}")
    if len(numbers) > 1 and took > 2.0:
        fail(command, condition, f"ends {took:.1f} s after the second signal")
    if children_of(folder):
        time.sleep(0.5)
        if children_of(folder):
            fail(command, condition, "a child outlives it")
    whole_files(command, folder, condition)


def long_ones(scratch_folder):
    for number, command in enumerate(LONG):
        progress(f"signals: {command.name}")
        for signal_number in (signal.SIGHUP, signal.SIGINT, signal.SIGTERM):
            folder = prepare(scratch_folder / f"long{number}-{signal_number.name}")
            # A safe stop is a result; an interrupted session has failed.
            codes = {0} if command.name.startswith("run") and "scenario" not in command.name else {0, 1, 3, 130}
            stop(command, folder, [signal_number], codes, signal_number.name)
        folder = prepare(scratch_folder / f"long{number}-twice")
        stop(command, folder, [signal.SIGTERM, signal.SIGTERM], set(range(0, 256)), "TERM twice")
        folder = prepare(scratch_folder / f"long{number}-second")
        first = begin(command, folder)
        at_work(first, command, folder)
        run(command, folder, "a second copy in the same folder", {2})
        first.send_signal(signal.SIGTERM)
        first.communicate(timeout=20)
        folder = prepare(scratch_folder / f"long{number}-kill")
        process = begin(command, folder)
        at_work(process, command, folder)
        process.kill()
        process.communicate()
        time.sleep(0.5)
        if children_of(folder):
            fail(command, "KILL", "a child outlives it")
        whole_files(Command(command.name, [], writes=()), folder, "KILL")


with scratch() as name:
    scratch_folder = Path(name).resolve()
    os.chmod(scratch_folder, 0o755)
    PREPARED = scratch_folder / "prepared"
    PREPARED.mkdir()
    (PREPARED / "long.yaml").write_text(LONG_SCENARIO)
    (PREPARED / "short.yaml").write_text(SHORT_SCENARIO)
    (PREPARED / "ugly.yaml").write_text(Path(SQUAT).read_text().replace(": ", ":  "))
    shutil.copy(SQUAT, PREPARED / "mine.yaml")
    subprocess.run([PROGRAM, "run", SQUAT, "--log", "log", "--no-report", "--quiet"], cwd=PREPARED, check=True)
    short_ones(scratch_folder)
    long_ones(scratch_folder)
progress_done()
for text in failures:
    print(text, file=sys.stderr)
finish(f"{tried - len(failures)} of {tried} cases", not failures)
