#!/usr/bin/env python3
"""Usage: tools/acceptance.d/house/moves.py [BEFORE [AFTER]]

A change that only moves code changes no run: builds two revisions, runs every shipped behavior with 20 seeds on each, and
compares all messages of the logs byte for byte, channel by channel. What differs by design (build id, version, absolute
paths) is in the header and the attachments, which are left out. Default: the revisions before and after the sources
moved into subfolders.
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import ctypes
import hashlib
import struct
import subprocess
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

from rows import PROCESSES, ROOT, finish, give_up, progress, progress_done, scratch

BEFORE, AFTER = (sys.argv[1:] + ["b50e3ae", "cf6d74b"][len(sys.argv) - 1:])[:2]
CHANNELS = {"/inputs", "/plans", "/edits", "/events", "/signals", "/parameters"}
SEEDS = range(1, 21)
TIME = "4s"
MCAP_HEAD = 8  # bytes of the magic
SCHEMA, CHANNEL, MESSAGE, CHUNK, DATA_END = 3, 4, 5, 6, 15  # opcodes, https://mcap.dev/spec


def build(revision, folder):
    """A clone of the project at a revision with `footfall` built in it."""
    steps = [["git", "clone", "--quiet", str(ROOT), str(folder)], ["git", "-C", str(folder), "checkout", "--quiet", revision],
             ["cmake", "--preset", "release", "-S", str(folder)],
             ["cmake", "--build", str(folder / "build" / "release"), "--target", "footfall"]]
    for step in steps:
        progress(f"{revision}: {' '.join(step[:2])}")
        done = subprocess.run(step, cwd=folder if folder.is_dir() else ROOT, stdin=subprocess.DEVNULL, capture_output=True,
                              text=True)
        if done.returncode:
            give_up(f"{revision}: {' '.join(step[:3])} failed: {(done.stderr or done.stdout).strip()[-200:]}")


def behaviors(folder):
    """Every shipped behavior that runs on a robot."""
    files = sorted([*folder.glob("behaviors/library/*.yaml"), *folder.glob("examples/*.yaml")])
    texts = {f: f.read_text(encoding="utf-8") for f in files}
    return [str(f.relative_to(folder)) for f, text in texts.items()
            if "\nsweep:" not in "\n" + text and ("\nrobot:" in text or "\nbase:" in text)]


def run_all(folder, out):
    def run(case):
        behavior, seed = case
        log = out / f"{Path(behavior).stem}-{seed}"
        subprocess.run([folder / "build/release/apps/footfall", "run", behavior, "--for", TIME, "--seed", str(seed), "--log", log,
                        "--no-report"], cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, check=False)
    with ThreadPoolExecutor(PROCESSES) as pool:
        list(pool.map(run, [(b, s) for b in behaviors(folder) for s in SEEDS]))


def digests(path):
    """{channel: (SHA-256 of its messages with their times, number of messages)} of an MCAP file."""
    zstd = ctypes.CDLL("libzstd.so.1")
    zstd.ZSTD_decompress.restype = ctypes.c_size_t
    names, found = {}, {}

    def records(data):
        at = 0
        while at + 9 <= len(data):
            size = struct.unpack_from("<Q", data, at + 1)[0]
            yield data[at], data[at + 9:at + 9 + size]
            at += 9 + size

    def visit(opcode, record):
        if opcode == CHANNEL:
            number, _, length = struct.unpack_from("<HHI", record)
            names[number] = record[8:8 + length].decode()
        elif opcode == MESSAGE:
            number, _, log_time, publish_time = struct.unpack_from("<HIQQ", record)
            state = found.setdefault(names[number], [hashlib.sha256(), 0])
            state[0].update(struct.pack("<QQ", log_time, publish_time) + record[22:])
            state[1] += 1

    for opcode, record in records(path.read_bytes()[MCAP_HEAD:]):
        if opcode == DATA_END:
            break
        if opcode == CHUNK:
            size, length = struct.unpack_from("<Q", record, 16)[0], struct.unpack_from("<I", record, 28)[0]
            packed = struct.unpack_from("<Q", record, 32 + length)[0]
            data = record[40 + length:40 + length + packed]
            if record[32:32 + length] == b"zstd":
                plain = ctypes.create_string_buffer(size)
                if zstd.ZSTD_decompress(plain, ctypes.c_size_t(size), data, ctypes.c_size_t(len(data))) != size:
                    raise ValueError(f"{path}: a damaged chunk")
                data = plain.raw
            for inner in records(data):
                visit(*inner)
        else:
            visit(opcode, record)
    return {name: (state[0].hexdigest(), state[1]) for name, state in found.items() if name in CHANNELS}


def compare(pair):
    before, after = pair
    if not after.is_file():
        return f"{before.parent.name}: no log", {}
    a, b = digests(before), digests(after)
    different = sorted(c for c in a.keys() | b.keys() if a.get(c) != b.get(c))
    return (f"{before.parent.name}: {' '.join(different)}" if different else None), {c: n for c, (_, n) in a.items()}


if __name__ == "__main__":
    with scratch() as name:
        folder = Path(name)
        for revision, label in ((BEFORE, "before"), (AFTER, "after")):
            build(revision, folder / label)
            progress(f"{revision}: runs")
            run_all(folder / label, folder / f"{label}-logs")
        pairs = [(log, folder / "after-logs" / log.parent.name / "log.mcap")
                 for log in sorted((folder / "before-logs").glob("*/log.mcap"))]
        if not pairs:
            give_up("no logs")
        with ProcessPoolExecutor(PROCESSES) as pool:
            results = list(pool.map(compare, pairs))
    progress_done()
    different = [text for text, _ in results if text]
    messages = sum(n for _, counts in results for n in counts.values())
    finish(f"{len(results) - len(different)} of {len(results)} logs byte-identical ({messages} messages)"
           + "".join(f"; {text}" for text in different[:3]), not different and len(results) >= 20)
