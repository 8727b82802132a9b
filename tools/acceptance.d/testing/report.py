#!/usr/bin/env python3
"""The report of a stepping minute in a headless Chromium: size, load time (median of 3), requests, console errors, Tab
through every control, keys, width of a phone."""
import json
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import BEST, BUILD, FOOTFALL, ROOT, SEED, finish, give_up, run, scratch

MAX_MB, MAX_S = 5.0, 2.0

browser = BUILD / "tests" / "runs" / "browser" / "npm"
chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
if not chromium or not (browser / "page.mjs").exists():
    give_up("no chromium, or the tests were built without npm")
if not (browser / "node_modules").exists():
    subprocess.run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error"], cwd=browser,
                   stdin=subprocess.DEVNULL, capture_output=True, timeout=240, check=False)
with scratch() as folder:
    page = Path(folder) / "report.html"
    try:
        result = run(BEST, "--seed", SEED, "--for", "60s", "--log", folder, log=True)
        subprocess.run([FOOTFALL, "report", folder, "-o", page], cwd=ROOT, stdin=subprocess.DEVNULL, check=True,
                       capture_output=True, timeout=300)
        done = subprocess.run(["node", browser / "page.mjs", chromium, page], stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=300, check=True)
        if done.stdout.startswith("skipped"):
            give_up(done.stdout.strip())
        seen = json.loads(done.stdout.splitlines()[-1])
    except (OSError, RuntimeError, ValueError, subprocess.SubprocessError) as problem:
        give_up(problem)
if result["time_s"] < 59.9 or result["steps"] < 100:
    give_up(f"only {result['steps']} steps in {result['time_s']} s")
megabytes, seconds = seen["bytes"] / 1e6, seen["load_ms"] / 1e3
wrong = seen["complaints"]
finish(f"{megabytes:.1f} MB a minute, loads in {seconds:.2f} s, {len(seen['requests'])} requests, "
       f"{len(seen['errors'])} console errors, Tab reaches {seen['reached']} of {seen['controls']} controls"
       + (f"; {'; '.join(wrong)}" if wrong else ""), megabytes < MAX_MB and seconds < MAX_S and not wrong)
