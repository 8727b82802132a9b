#!/usr/bin/env python3
"""Runs what the documents say: every `$ footfall ...` line of a ```console block, and compares what follows.

A ```yaml block whose first line is `# file: PATH` must be that file's text, from its first line after comments on or
whole; in a console block a line `...` stands for any lines, `...` inside a line for any text.
usage: run_docs.py FOOTFALL_PROGRAM DOCUMENT...
"""
import difflib
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile

import documents

ROOT = pathlib.Path(__file__).resolve().parents[3]
QUICK = {"check", "trace", "signals", "config", "set", "fmt", "graph", "new", "schema"}  # commands that run no physics


def run_console(program, where, lines, folder):
    """Runs each command of a block in a folder that holds the examples; returns the failures."""
    failures, count, at = [], 0, 0
    while at < len(lines):
        command = lines[at]
        at += 1
        expected = []
        while at < len(lines) and not lines[at].startswith("$ "):
            expected.append(lines[at])
            at += 1
        words = shlex.split(command[2:], comments=True) if command.startswith("$ ") else []
        if len(words) < 2 or words[0] != "footfall" or words[1] not in QUICK:
            continue
        count += 1
        done = subprocess.run([program, *words[1:]], cwd=folder, text=True, timeout=60, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        actual = done.stdout.splitlines()
        if expected and not documents.matches(expected, actual):
            shown = "\n".join(difflib.unified_diff(expected, actual, "document", "program", lineterm=""))
            failures.append(f"{where}: {command}\n{shown}")
    return failures, count


def check_file(where, lines):
    """A block that quotes a file holds its text."""
    path = lines[0].removeprefix("# file:").strip()
    quoted = "\n".join(lines[1:]).strip()
    try:
        text = (ROOT / path).read_text()
    except OSError as error:
        return [f"{where}: {error}"]
    return [] if quoted in text else [f"{where}: the block is not what {path} holds"]


def main():
    program = os.path.abspath(sys.argv[1])
    failures, commands, files = [], 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for name in ("examples", "behaviors", "robots", "sim", "docs"):
            os.symlink(ROOT / name, os.path.join(folder, name))
        for document in sys.argv[2:]:
            text = (ROOT / document).read_text()
            for language, line, lines in documents.blocks(text):
                where = f"{document}:{line}"
                if lines and lines[0].startswith("# file:"):
                    failures += check_file(where, lines)
                    files += 1
                elif language == "yaml" and lines and lines[0].startswith("# save:"):
                    path = pathlib.Path(folder) / lines[0].removeprefix("# save:").strip()
                    path.write_text("\n".join(lines[1:]) + "\n")
                elif language == "console":
                    bad, count = run_console(program, where, lines, folder)
                    failures += bad
                    commands += count
    for failure in failures:
        print(failure, file=sys.stderr)
    print(f"{commands} commands, {files} quoted files, {len(failures)} failures")
    if commands == 0:
        print("no command was found: the documents lost their console blocks?", file=sys.stderr)
    return 1 if failures or commands == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
