#!/usr/bin/env python3
"""Physics checks: impossible behaviors are refused at the right position, the library has no findings."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import math
import re
import statistics
import subprocess
import time

from rows import BALANCE, FOOTFALL, ROOT, finish, give_up, progress, progress_done, scratch

SHIPPED = [*sorted((ROOT / "behaviors" / "library").glob("*.yaml")), *sorted((ROOT / "examples").glob("*.yaml")),
           ROOT / "tests" / "unit" / "behaviors" / "load" / "kim2016_printed.yaml"]
PRINTED_KAPPA = ("kappa: [0.4, 0.4]", "kappa: {value: [-0.4, -0.4], range: [-1, 1]}")
AT_935_MM = ("height: {value: 0.91 m}", "height: {value: 0.935 m}")
COAST = ("      coast: {type: com_position, axes: [x, y], priority: 2, reference: entry}"
         "  # damped joints would make a late foot pull\n")
# Mistakes: replacements in the library's balance, exit code with --strict, words of one message line, its position.
CASES = {
    "yaw on one point foot": (
        [("axes: [pitch, roll], priority: 1, reference: 0}", "axes: [pitch, roll, yaw], priority: 1, reference: 0}"),
         ("attitude: {kp: [200, 210], ki: [20, 35], kd: [15, 10]}",
          "attitude: {kp: [200, 210, 100], ki: [20, 35, 0], kd: [15, 10, 0]}")],
        2, ["error:", "'yaw'", "no contact can produce it"], "yaw]"),
    "freedom without a task on two feet": (
        [(COAST, ""), ("    coast: {kd: 0}\n", "")],
        1, ["warning:", "1 of 5 actuated directions has no task", "joint_damping"],
        "height: {type: com_position"),
    "the printed sign of kappa": ([PRINTED_KAPPA, AT_935_MM], 2, ["error:", "planner 'foot' diverges"],
                                  "{value: [-0.4"),
    "internal force outside the friction cone": (
        [(COAST, COAST + "    internal: {tension: {between: [right_foot, left_foot], reference: 100 N}}\n")],
        2, ["error:", "internal force 'tension'", "friction cone"], "100 N"),
}


def check(path, cwd=ROOT):
    done = subprocess.run([FOOTFALL, "check", "--strict", str(path)], cwd=cwd, stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, timeout=60)
    return done.returncode, done.stderr


def place(text, token):
    before = text[:text.index(token)]
    return f":{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}:"


def eigenvalue(kappa, reversal, height, step):
    """Largest eigenvalue of the map from switch to switch: pendulum for T about the foot at (1+k)x + coth(wt')/w v."""
    w = math.sqrt(9.81 / height)
    c, s = math.cosh(w * step), math.sinh(w * step)
    p, q = 1 + kappa, 1 / (w * math.tanh(w * reversal))
    a, b, d, e = c + (1 - c) * p, s / w + (1 - c) * q, w * s - w * s * p, c - w * s * q
    root = math.sqrt((a + e) ** 2 / 4 - (a * e - b * d))
    return max((a + e) / 2 + root, (a + e) / 2 - root, key=abs)


def judge(name, folder):
    """None if the output for the broken file is correct, else the problem."""
    changes, code, words, token = CASES[name]
    text = (ROOT / BALANCE).read_text(encoding="utf-8")
    for old, new in changes:
        if old not in text:
            give_up(f"'{old}' is not in {BALANCE} any more")
        text = text.replace(old, new, 1)
    path = folder / "broken.yaml"
    path.write_text(text, encoding="utf-8")
    got, errors = check(path)
    line = next((x for x in errors.splitlines() if all(w in x for w in words)), None)
    if got != code or line is None:
        return f"{name}: exit {got}, {errors.strip() or 'nothing said'}"
    return None if place(text, token) in line else f"{name}: wrong place: {line}"


def judge_eigenvalue(folder):
    """The planner's eigenvalue as printed by `check`, and the problem with it."""
    text = (ROOT / BALANCE).read_text(encoding="utf-8")
    for old, new in (PRINTED_KAPPA, AT_935_MM):
        text = text.replace(old, new, 1)
    path = folder / "kappa.yaml"
    path.write_text(text, encoding="utf-8")
    found = re.search(r" is (\S+) \(kappa (\S+), reversal (\S+) ms, height h (\S+) m, step time T (\S+) s\)", check(path)[1])
    if not found:
        return float("nan"), "no eigenvalue said"
    said, kappa, reversal, height, step = map(float, found.groups())
    if (height, step) != (0.935, 0.335):
        return said, f"judged at h {height} m, T {step} s"
    right = abs(said - 1.28) <= 0.01 and abs(said - eigenvalue(kappa, reversal / 1e3, height, step)) <= 1e-3
    return said, None if right else f"eigenvalue {said}"


wrong = []
with scratch() as folder:
    for case in CASES:
        progress(case)
        wrong.append(judge(case, Path(folder)))
    value, problem = judge_eigenvalue(Path(folder))
    wrong.append(problem)
unclean = [f"{p.name}: {check(p)[1].strip()}" for p in SHIPPED if check(p) != (0, "")]
seconds = []
for _ in range(5):
    begin = time.monotonic()
    check(ROOT / BALANCE)
    seconds.append(time.monotonic() - begin)
progress_done()
wrong = [w for w in wrong if w] + unclean
finish(f"{len(CASES)} mistakes, each found at its place; printed kappa: eigenvalue {value:g} at h 0.935 m, T 0.335 s; "
       f"{len(SHIPPED) - len(unclean)} of {len(SHIPPED)} shipped behaviors clean under --strict; "
       f"balance checked in {1e3 * statistics.median(seconds):.0f} ms" + "".join(f"; WRONG: {w}" for w in wrong),
       not wrong)
