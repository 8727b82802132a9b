#!/usr/bin/env python3
"""50 reloads while the tuned behavior steps, 10 of them of broken files: each valid file takes effect, the robot never
falls; each broken one is refused with exactly the text of `footfall check`, and the run continues."""
import os
import re
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import BEST, FOOTFALL, ROOT, SEED, finish, last_json, progress, progress_done, scratch

RELOADS = int(os.environ.get("FOOTFALL_RELOADS", "50"))
PATIENCE = 60.0  # s of wall time for one reload

# Valid files as a user would save them. {k} and {x} vary: x from 0.8 to 1.2.
GOOD = [
    "gains: {{single: {{swing: {{kp: {kp:.6g}, kd: {kd:.6g}}}}}}}",
    "gains: {{dual: {{attitude: {{kp: [{a:.6g}, {b:.6g}]}}}}}}",
    "parameters: {{lift_time: {{value: {lift:.6g} ms}}, land_time: {{value: {land:.6g} ms}}}}",
    "parameters: {{clearance: {{value: {clear:.6g} cm}}}}",
    "planners: {{foot: {{width_offset: {width:.6g} cm}}}}",
    "machine: {{transitions: [{{when: \"time < 0 s\", do: [{{log: \"never {k}\"}}], reason: edited}}]}}",
    "templates: {{stride: {{states: {{dual: {{doc: \"edited {k}\", after: \"= {x:.6g}*$dual_time\"}}}}}}}}",
    "machine: {{states: {{rest{k}: {{stack: dual}}}}, transitions: [{{when: \"time < 0 s\", to: rest{k}}}]}}",
]
BROKEN = [
    "gains: {single: {swing: {kp: 4 N}}}",
    "gains: {single: {swing: {kq: 4}}}",
    "machine: {initial: stepp}",
    "parameters: {lift_time: {value: 900 ms}}",
    "machine: [",
    "templates: {stride: {states: {land: {to: laod}}}}",
    "planners: {foot: {kappa: {value: [-0.5, 0.25], range: [-1, 1]}}}",
    "stacks: {single: {tasks: {attitude: {axes: [yaw, pitch, roll], gains: {kp: 100, kd: 10}}}}}",
    "templates: {stride: {states: {dual: {after: 100 N}, lift: {stack: single}}}}",
    "machine: {transitions: [{when: \"com.pos.q > 1 m\", to: limp}]}",
]


def good(k):
    x = 0.8 + 0.4 * ((7 * k) % 11) / 10
    values = {"k": k, "x": x, "kp": 400 * x, "kd": 60 * x, "a": 200 * x, "b": 210 * x, "lift": 145 * x, "land": 150 * x,
              "clear": 6 * x, "width": 3 * x}
    return GOOD[k % len(GOOD)].format(**values)


class Run:
    """A run with --reload, and its output so far."""

    def __init__(self, file, folder):
        self.process = subprocess.Popen(
            [FOOTFALL, "run", str(file), "--reload", "--seed", str(SEED), "--for", "36000s", "--json", "--no-report", "--log",
             str(folder)], cwd=ROOT, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.lines = []
        threading.Thread(target=self.read, daemon=True).start()

    def read(self):
        for line in self.process.stderr:
            self.lines.append(line.rstrip("\n"))

    def verdict(self, first):
        """Waits for the complete message from line `first` on; (kind, lines)."""
        until = time.monotonic() + PATIENCE
        while time.monotonic() < until and self.process.poll() is None:
            new = self.lines[first:]
            for i, line in enumerate(new):
                if re.search(r": reloaded at [\d.]+ s, in ", line):
                    return "reloaded", new[:i]
                if line.endswith(": not reloaded:") and len(new) > i + 1:
                    return "refused", new[:i]
            time.sleep(0.02)
        return "nothing", self.lines[first:]


def words_of_check(file):
    done = subprocess.run([FOOTFALL, "check", str(file)], cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    return done.returncode, [line for line in (done.stderr + done.stdout).splitlines()
                             if not re.match(r"\d+ files? checked", line)]


def save(file, text):
    """Saves in two steps, as some editors do."""
    half = len(text) // 2
    with open(file, "w", encoding="utf-8") as out:
        out.write(text[:half])
        out.flush()
        time.sleep(0.05)
        out.write(text[half:])


def one(run, file, k, broken):
    """Saves the k-th file; empty if the reaction is correct, else the problem."""
    text = BROKEN[(k // 5) % len(BROKEN)] if broken else good(k)
    before = len(run.lines)
    save(file, f"base: {ROOT / BEST}\n{text}\n")
    kind, told = run.verdict(before)
    if broken:
        code, words = words_of_check(file)
        if code != 2 or kind != "refused":
            return f"file {k} ({text}): {kind}, check says {code}"
        return "" if told == words else f"file {k}: run told {told}, check {words}"
    return "" if kind == "reloaded" else f"file {k} ({text}): {kind}: {run.lines[before:]}"


with scratch() as top:
    file, folder = Path(top) / "edited.yaml", Path(top) / "run"
    file.write_text(f"base: {ROOT / BEST}\n", encoding="utf-8")
    run = Run(file, folder)
    problems, refused, reloaded = [], 0, 0
    time.sleep(3.0)
    for k in range(RELOADS):
        broken = k % 5 == 4
        wrong = one(run, file, k, broken)
        problems += [wrong] if wrong else []
        refused += broken and not wrong
        reloaded += not broken and not wrong
        progress(f"{k + 1} of {RELOADS} files")
        if run.process.poll() is not None:
            break
    progress_done()
    run.process.send_signal(signal.SIGINT)
    result = last_json(run.process.stdout.read())
    run.process.wait(timeout=60)
    segments = len(list(folder.glob("reload-*/log.mcap")))
print("\n".join(problems), file=sys.stderr)
steps, fell = result["steps"], result["fell"] or result["end"] != "stopped"
faults = {name: n for name, n in result.get("faults", {}).items() if n}
finish(f"{RELOADS} files saved in {result['time_s']:.0f} s of stepping ({steps} steps): {reloaded} took over, {refused} "
       f"broken ones refused in the words of check, {'a fall' if fell else 'no fall'}; {segments} logs; "
       f"faults {faults or 'none'}",
       not problems and not fell and steps > RELOADS and reloaded + refused == RELOADS)
