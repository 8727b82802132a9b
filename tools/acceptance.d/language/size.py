#!/usr/bin/env python3
"""The balance behavior is short: lines of behaviors/library/balance.yaml, and whether fmt would change it."""
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import rows

PATH = "behaviors/library/balance.yaml"
LIMIT = 90

lines = len((rows.ROOT / PATH).read_text().splitlines())
canonical = subprocess.run([rows.FOOTFALL, "fmt", "--check", PATH], cwd=rows.ROOT).returncode == 0
rows.finish(f"{lines} lines, {'canonical' if canonical else 'not canonical'} layout", lines < LIMIT and canonical)
