#!/usr/bin/env python3
"""Usage: apply_changes.py ROOT

Checks every tests/changes/*.patch: it applies to the tree, and touches at most four files, tests and documents aside.
Prints a line a patch; exit 1 if one does not hold.
"""
import re
import subprocess
import sys
from pathlib import Path

MOST_FILES = 4
ASIDE = re.compile(r"(tests|docs)/|CHANGELOG\.md$")


def files_touched(patch):
    names = re.findall(r"^diff --git a/(\S+) b/\S+$", patch, re.M)
    return [name for name in names if not ASIDE.match(name)]


def main(root):
    patches = sorted(Path(root, "tests/changes").glob("*.patch"))
    failed = not patches
    for path in patches:
        files = files_touched(path.read_text(encoding="utf-8"))
        applied = subprocess.run(["git", "apply", "--check", str(path)], cwd=root, capture_output=True, text=True)
        good = applied.returncode == 0 and 0 < len(files) <= MOST_FILES
        failed |= not good
        print(f"{'ok' if good else 'FAILED'}: {path.name} touches {len(files)}: {', '.join(files)}")
        print(applied.stderr, end="")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
