#!/usr/bin/env python3
"""Usage: tests/language/fuzz/hostile_files.py FOOTFALL [--small] [NAME...]

Writes files made to harm a reader (alias bombs, endless nesting, 50 MB, bytes that are no text ...) and gives each to
`footfall check`: it must end by itself with an error message and exit code 2, within 1 s and 200 MB.
Prints one line for each file that does not, and a summary. Exit: 0 all do, 1 some do not.

  --small   without the files that are read to their end before they are refused, which takes the time of the others
"""
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SECONDS = 1.0
MEGABYTES = 200
DEEP = 100_000
KEYS = 1_000_000
HEAD = b"behavior: 1\n"
READ_TO_THE_END = {
    "a scalar of 3.5 MB", "a scalar of 3.5 MB in quotes", "a block scalar of 3.5 MB", "a key of 3.5 MB",
    "a quote of 3.5 MB never closed", "10^5 unknown keys", "10^5 times the same key", "10^6 items", "10^5 anchors",
    "10^6 terms", "10^5 unknown names", "10^4 states nobody finds", "2 10^4 events of one state"}


def alias_bomb(levels=20, width=10):
    lines = ["a0: &a0 [1, 2, 3]"]
    lines += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * width)}]" for i in range(1, levels)]
    return HEAD + "\n".join(lines).encode() + b"\n"


def block_nesting(depth):
    """A key inside a key, each a blank further in, as far as 4 MB go."""
    lines, size = [], 0
    for i in range(depth):
        lines.append(" " * i + "a:")
        size += i + 3
        if size > 7 << 19:
            break
    return HEAD + "\n".join(lines).encode() + b"\n"


def template_bomb(levels=30):
    """Templates that use each other twice: 2^30 states."""
    lines = ["templates:"]
    for i in range(levels):
        uses = f"{{x: {{use: t{i + 1}}}, y: {{use: t{i + 1}}}}}" if i + 1 < levels else "{x: {}}"
        lines.append(f"  t{i}: {{states: {uses}}}")
    return HEAD + "\n".join(lines + ["machine: {use: t0}", ""]).encode()


def many(count, line):
    return b"".join(line(i) for i in range(count))


def machine(text):
    return HEAD + b"machine:\n" + text


def files():
    """(name, function that makes its bytes)."""
    yield "alias bomb", lambda: alias_bomb()
    yield "alias bomb of text", lambda: HEAD + b"a: &a " + b"x" * 100_000 + b"\nb: [" + b"*a, " * 100_000 + b"*a]\n"
    yield "self-reference in a list", lambda: HEAD + b"a: &x [1, *x]\n"
    yield "self-reference in a map", lambda: HEAD + b"a: &x {b: {c: *x}}\n"
    yield "unknown alias", lambda: HEAD + b"a: *nobody\n"
    yield "flow lists 10^5 deep", lambda: HEAD + b"a: " + b"[" * DEEP + b"]" * DEEP + b"\n"
    yield "flow lists 10^5 deep, open", lambda: HEAD + b"a: " + b"[" * DEEP
    yield "flow maps 10^5 deep", lambda: HEAD + b"a: " + b"{a: " * DEEP + b"1" + b"}" * DEEP + b"\n"
    yield "block maps as deep as 4 MB go", lambda: block_nesting(DEEP)
    yield "block lists 10^5 deep", lambda: HEAD + b"a:\n  " + b"- " * DEEP + b"1\n"
    yield "question marks 10^5 deep", lambda: HEAD + b"? " * DEEP + b"a\n"
    yield "invalid UTF-8", lambda: HEAD + b"name: \xff\xfe\x80abc\n"
    yield "overlong UTF-8", lambda: HEAD + b"name: \xc0\xaf\n"
    yield "half a character", lambda: HEAD + b"name: \xe2\x82"
    yield "UTF-16", lambda: "behavior: 1\nname: x\n".encode("utf-16")
    yield "NUL bytes", lambda: HEAD + b"name: a\0b\n"
    yield "nothing but NUL bytes", lambda: b"\0" * 1_000_000
    yield "empty", lambda: b""
    yield "random bytes", lambda: bytes((i * 7919 + (i >> 3) * 104729) & 0xFF for i in range(100_000))
    yield "50 MB of text", lambda: HEAD + b"name: " + b"x" * (50 << 20)
    yield "50 MB of comments", lambda: HEAD + b"# nothing\n" * (5 << 20)
    yield "a scalar of 3.5 MB", lambda: HEAD + b"name: [" + b"x" * (7 << 19) + b"]\n"
    yield "a scalar of 3.5 MB in quotes", lambda: HEAD + b'robot: "' + b"\\x41" * (7 << 17) + b'"\n'
    yield "a block scalar of 3.5 MB", lambda: HEAD + b"doc: |\n" + b"  line\n" * (1 << 19) + b"robot: {}\n"
    yield "a key of 3.5 MB", lambda: HEAD + b"x" * (7 << 19) + b": 1\n"
    yield "a quote of 3.5 MB never closed", lambda: HEAD + b'name: "' + b"x y " * (7 << 17)
    yield "10^6 keys", lambda: HEAD + many(KEYS, lambda i: b"k%d: 1\n" % i)
    yield "10^6 keys on one line", lambda: HEAD + b"a: {" + many(KEYS, lambda i: b"k%d, " % i) + b"}\n"
    yield "10^5 unknown keys", lambda: HEAD + many(100_000, lambda i: b"k%d: 1\n" % i)
    yield "10^5 times the same key", lambda: HEAD + b"a: 1\n" * 100_000
    yield "10^6 items", lambda: HEAD + b"a: [" + b"1, " * KEYS + b"1]\n"
    yield "10^5 tabs", lambda: HEAD + b"\ta: 1\n" * 100_000
    yield "10^5 anchors", lambda: HEAD + b"a: [" + many(100_000, lambda i: b"&a%d 1, " % i) + b"1]\n"
    yield "10^5 documents", lambda: b"---\nbehavior: 1\n" * 100_000
    yield "10^5 brackets in a condition", lambda: machine(b"  transitions: [{when: \"" + b"(" * DEEP + b"1\", to: a}]\n")
    yield "10^5 signs in a condition", lambda: machine(b"  transitions: [{when: \"" + b"-" * DEEP + b"1\", to: a}]\n")
    yield "10^6 terms", lambda: machine(b"  transitions: [{when: \"1" + b"+1" * KEYS + b"\", to: a}]\n")
    yield "10^5 choices", lambda: machine(b"  transitions: [{when: \"" + b"1?1:" * DEEP + b"1\", to: a}]\n")
    yield "10^5 unknown names", lambda: machine(b"  transitions: [{when: \"" + b"a.b.c + " * DEEP + b"1\", to: a}]\n")
    yield "template bomb", lambda: template_bomb()
    yield "a template in itself", lambda: HEAD + b"templates: {t: {states: {a: {use: t}}}}\nmachine: {use: t}\n"
    yield "10^4 states nobody finds", lambda: machine(b"  states:\n" + many(10_000, lambda i: b"    s%d: {on_exit: [], transitions: [{on: e, to: z%d}]}\n" % (i, i)))
    yield "2 10^4 events of one state", lambda: machine(b"  states:\n    a:\n      transitions:\n" + many(20_000, lambda i: b"        - {on: e%d, to: b}\n" % i) + b"    b: {after: 1 s, to: nowhere}\n")
    yield "its own base", lambda: b"base: file.yaml\nbehavior: 1\n"
    yield "a base that never ends", lambda: b"base: /dev/zero\nbehavior: 1\n"
    yield "a robot that never ends", lambda: HEAD + b"robot: /dev/zero\nmachine: {}\n"
    yield "a base that is a pipe", lambda: b"base: pipe\nbehavior: 1\n"
    yield "a robot that is a pipe", lambda: HEAD + b"robot: pipe\nmachine: {}\n"
    yield "a base that is a folder", lambda: b"base: .\nbehavior: 1\n"
    yield "a model that never ends", lambda: b"robot: 1\nmodel: /dev/zero\n"


def write_apart(path, content):
    """In a process of its own: the memory of this one counts into the peak of those that it starts."""
    child = os.fork()
    if child == 0:
        path.write_bytes(content())
        os._exit(0)
    os.waitpid(child, 0)


def judge(footfall, path):
    """(problem or None, seconds, peak MB of `footfall check`)."""
    begin = time.monotonic()
    with tempfile.TemporaryFile() as output:
        process = subprocess.Popen([footfall, "check", path.name], cwd=path.parent, stdin=subprocess.DEVNULL,
                                   stdout=output, stderr=output)
        while True:
            done, status, usage = os.wait4(process.pid, os.WNOHANG)
            seconds = time.monotonic() - begin
            if done or seconds > 20 * SECONDS:
                break
            time.sleep(0.002)
        if not done:
            process.kill()
            _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        said = b"error:" in output.read()
    peak = usage.ru_maxrss / 1024
    used = usage.ru_utime + usage.ru_stime  # the machine may do other things
    problem = (f"does not end within {seconds:.0f} s" if not done
               else f"exit {process.returncode}" if process.returncode != 2
               else "no error message" if not said
               else f"{used:.2f} s" if used > SECONDS
               else f"{peak:.0f} MB" if peak > MEGABYTES else None)
    return problem, used, peak


def check_all(footfall, wanted=(), small=False):
    """([problems], count, longest time in s, largest memory in MB)."""
    problems, count, longest, largest = [], 0, 0.0, 0.0
    with tempfile.TemporaryDirectory(prefix="footfall-hostile-") as folder:
        os.mkfifo(Path(folder) / "pipe")
        for name, content in files():
            if (wanted and name not in wanted) or (small and name in READ_TO_THE_END):
                continue
            path = Path(folder) / "file.yaml"
            write_apart(path, content)
            problem, seconds, peak = judge(footfall, path)
            if os.environ.get("VERBOSE"):
                print(f"{seconds:5.2f} s {peak:4.0f} MB  {name}", file=sys.stderr)
            count, longest, largest = count + 1, max(longest, seconds), max(largest, peak)
            problems += [f"{name}: {problem}"] if problem else []
    return problems, count, longest, largest


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    found, number, slowest, biggest = check_all(os.path.abspath(sys.argv[1]), [a for a in sys.argv[2:] if a != "--small"],
                                                "--small" in sys.argv)
    for line in found:
        print(line)
    print(f"{number - len(found)} of {number} hostile files refused, at most {slowest:.2f} s and {biggest:.0f} MB")
    sys.exit(1 if found else 0)
