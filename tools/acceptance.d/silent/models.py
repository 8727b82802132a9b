#!/usr/bin/env python3
"""Thirty models, each the biped of robots/scaffolds with one edit that only one of simulator and control model knows (or that
the world replaces): `check` tells each, of the robot file and of a behavior on it, at the line and column of the element or
attribute. Four edits that change nothing are not told. `FOOTFALL` sets another program."""
import json
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from rows import FOOTFALL, ROOT, finish, progress, progress_done, scratch

PROGRAM = str(Path(FOOTFALL).resolve())
SCAFFOLD = ROOT / "robots" / "scaffolds" / "biped"
HIP = '@<motor name="right_hip" joint="right_hip"/>'
LAST = '@<motor name="left_knee" joint="left_knee"/>'  # MuJoCo wants what has a state last
END = "  </actuator>"
FOOT = '@<geom name="right_foot" type="sphere" size="0.02" pos="0 0 -0.346" mass="0.05" contype="3" conaffinity="12"/>'
KNEE = '<joint name="right_knee" axis="0 1 0" range="-5 150"/>'
BASE = '@<body name="torso" pos="0 0 0.712">'
DEFAULT = '<joint type="hinge" limited="true"/>'

# name: (text of biped.xml without '@', its replacement with '@' before the place that is told, severity, a part of the text)
CASES = {
    "position actuator": (HIP, '@<position name="right_hip" joint="right_hip" kp="100"/>', "error", "no plain motor"),
    "velocity actuator": (HIP, '@<velocity name="right_hip" joint="right_hip" kv="1"/>', "error", "no plain motor"),
    "a velocity beside the motor": (END, '@<velocity joint="right_hip" kv="1"/>' + END, "error", "second actuator"),
    "general with a gain": (HIP, '<general name="right_hip" joint="right_hip" @gainprm="2"/>', "error", "2 times the torque"),
    "general with activation": (LAST, '@<general joint="left_knee" dyntype="filter" dynprm="0.05"/>', "error", "no plain motor"),
    "muscle": (LAST, '@<muscle joint="left_knee" lengthrange="0.1 1"/>', "error", "no plain motor"),
    "gear": (HIP, '<motor name="right_hip" joint="right_hip" @gear="3"/>', "error", "3 times the torque"),
    "gear by default": ('<motor @gear="1"', '<motor @gear="2"', "error", "2 times the torque"),
    "range of control": (HIP, '<motor joint="right_hip" @ctrlrange="-1 1"/>', "error", "without a fault"),
    "range of force": (HIP, '<motor joint="right_hip" forcelimited="true" @forcerange="-60 20"/>', "error", "without a fault"),
    "motor on a site": (END, '@<motor site="imu"/>' + END, "error", "acts on a site"),
    "joint without a motor": (HIP, "", "error", "has no motor"),
    "timestep": ("  <default>", '  <option @timestep="0.004"/><default>', "warning", "dropped"),
    "gravity": ("  <default>", '  <option @gravity="0 0 -1.62"/><default>', "warning", "dropped"),
    "fluid": ("  <default>", '  <option @density="1000"/><default>', "warning", "dropped"),
    "flag": ("  <default>", '  <option><flag @contact="disable"/></option><default>', "warning", "dropped"),
    "feet that meet nothing": (FOOT, FOOT[1:].replace('contype="3" conaffinity="12"', '@contype="0" conaffinity="0"'), "error", "falls through"),
    "margin by default": ('condim="3" friction', 'condim="3" @margin="0.01" friction', "warning", "10 mm above"),
    "priority": (FOOT, FOOT[1:].replace(" type=", ' @priority="1" friction="0.8" type='), "error", "replace the world's"),
    "ball of another radius": (FOOT, FOOT[1:].replace('size="0.02"', '@size="0.03"'), "warning", "30 mm in the simulator"),
    "box for a foot": ('@<site name="right_foot"', '@<site name="right_foot" group="1"', "error", "has no ball", ('name="right_foot" type="sphere" size="0.02"', 'name="right_foot" type="box" size="0.02 0.02 0.02"')),
    "mass of a shape that is only seen": (BASE, BASE[1:] + '<freejoint name="floating_base"/>@<geom size="0.05" mass="2" contype="0" conaffinity="0"/>', "error", "2 kg", ('<freejoint name="floating_base"/>\n', "\n")),
    "stiffness": (KNEE, KNEE.replace("axis", '@stiffness="5" axis'), "warning", "spring"),
    "damping by default": (DEFAULT, DEFAULT.replace("/>", ' @damping="0.5"/>'), "warning", "damping"),
    "dry friction in a class": (KNEE, KNEE.replace("axis", 'class="dry" axis'), "warning", "dry friction", ("  </default>\n  <worldbody>", '  <default class="dry"><joint @frictionloss="0.3"/></default></default>\n  <worldbody>')),
    "stop inside the limits": (KNEE, KNEE.replace('range="-5 150"', '@range="-5 90"'), "warning", "90 deg"),
    "spring of a tendon": ("  <actuator>", '  <tendon><fixed @stiffness="20"><joint joint="right_knee" coef="1"/></fixed></tendon><actuator>', "error", "tendon"),
    "equality constraint": ("  <actuator>", '  <equality>@<joint joint1="right_roll" joint2="left_roll"/></equality><actuator>', "error", "equality"),
    "base on its side": (BASE, BASE[1:].replace("pos", '@euler="90 0 0" pos'), "error", "tilted by 90 deg"),
    "a floor": ("  <worldbody>", '  <worldbody>@<geom type="plane" size="5 5 0.1"/>', "error", "brings a floor"),
}
HARMLESS = {
    "gravity as it is": ("  <default>", '  <option gravity="0 0 -9.81"/><default>'),
    "armature": (KNEE, KNEE.replace("axis", 'armature="0.02" axis')),
    "a sensor": ("  <actuator>", '  <sensor><gyro site="imu"/></sensor><actuator>'),
    "friction of a foot": (FOOT, FOOT[1:].replace(" type=", ' friction="0.2" type=')),
}
STAND = """behavior: 1
robot: robot.yaml
machine:
  contacts: [right_foot, left_foot]
  tasks:
    height: {type: com_position, axes: [z], priority: 1, reference: entry, gains: {kp: 100, kd: 10}}
    attitude: {type: body_orientation, priority: 1, reference: 0, gains: {kp: 100, kd: 15}}
    rest: {type: joint_damping, priority: 2, gains: {kd: 2}}
  states:
    stand: {after: 1 s, to: end}
    end: {type: final}
"""


def edited(text, before, after):
    before, after = before.replace("@", ""), after
    if text.replace("@", "").count(before) != 1:
        raise ValueError(f"'{before}' is not there once")
    return text.replace(before, after)


def told(folder, file):
    done = subprocess.run([PROGRAM, "check", file, "--json"], cwd=folder, capture_output=True, text=True, timeout=60)
    return json.loads(done.stdout)["files"][0]["diagnostics"]


def judge(folder, case):
    text = (SCAFFOLD / "biped.xml").read_text()
    text = edited(text, case[0], case[1])
    if len(case) > 4:
        text = edited(text, *case[4]) if "@" not in case[4][1] else edited(text.replace("@", ""), *case[4])
    place = None
    if "@" in text:
        head = text[: text.index("@")]
        place = (head.count("\n") + 1, len(head) - head.rfind("\n"))
    (folder / "biped.xml").write_text(text.replace("@", ""))
    for file in ("robot.yaml", "stand.yaml"):
        found = [d for d in told(folder, file) if d["id"] in ("model", "simulator-only")]
        if len(case) == 2:
            if found:
                return f"{file}: told of something harmless: {found[0]['text']}"
            continue
        fits = [d for d in found if d["severity"] == case[2] and case[3] in d["text"]]
        if not fits:
            return f"{file}: not told, but {[d['text'] for d in found]}"
        if not fits[0]["file"].endswith("biped.xml") or fits[0]["line"] == 0:
            return f"{file}: told without a place: {fits[0]}"
        if place and (fits[0]["line"], fits[0]["column"]) != place:
            return f"{file}: told at {fits[0]['line']}:{fits[0]['column']}, not at {place}"
    return None


good, failures = 0, []
with scratch() as name:
    folder = Path(name)
    shutil.copy(SCAFFOLD / "robot.yaml", folder)
    (folder / "stand.yaml").write_text(STAND)
    for case_name, case in {**CASES, **HARMLESS}.items():
        progress(case_name)
        problem = judge(folder, case)
        if problem:
            failures.append(f"{case_name}: {problem}")
        elif case_name in CASES:
            good += 1
progress_done()
for line in failures:
    print(line, file=sys.stderr)
finish(f"{good} of {len(CASES)}", not failures and len(CASES) == 30)
