#!/usr/bin/env python3
"""Bad input: one clear error each, exit 2 or 3, no crash, no hang."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import re
import shutil
import subprocess

from rows import BALANCE, FOOTFALL, ROOT, finish, progress, progress_done, scratch


def written(path, text):
    path.write_text(text, encoding="utf-8")
    return str(path)


def replaced(text, pattern, replacement):
    """`text` with the first match replaced; fails if there is no match."""
    changed, count = re.subn(pattern, replacement, text, count=1, flags=re.M)
    if not count:
        raise SystemExit(f"figure: not measured: nothing matches '{pattern}' in {BALANCE}")
    return changed


def cases(folder):
    """{name: [arguments of footfall]}; every file is made in `folder`, which is where footfall runs."""
    balance = (ROOT / BALANCE).read_text(encoding="utf-8")
    library = written(folder / "balance.yaml", balance)
    (folder / "sim").symlink_to(ROOT / "sim")
    shutil.copytree(ROOT / "robots" / "hume", folder / "robots" / "hume")
    broken = folder / "robots" / "broken"
    shutil.copytree(ROOT / "robots" / "hume", broken)
    for mjcf in broken.glob("*.xml"):
        mjcf.write_text(mjcf.read_text(encoding="utf-8").replace("</worldbody>", "</wurldbody>"), encoding="utf-8")
    robot = broken / "robot.yaml"
    robot.write_text(robot.read_text(encoding="utf-8").replace("name: hume", "name: broken"), encoding="utf-8")
    blocked = folder / "file"
    blocked.write_text("a file where a folder should be\n", encoding="utf-8")
    return {
        "unknown robot": ["run", written(folder / "robot.yaml", replaced(balance, r"^robot: .*$", "robot: humme"))],
        "missing file": ["run", str(folder / "nowhere.yaml")],
        "malformed MJCF": ["run", written(folder / "mjcf.yaml", replaced(balance, r"^robot: .*$", "robot: broken"))],
        "malformed YAML": ["run", written(folder / "yaml.yaml", balance + "\nunclosed: [1, 2\n")],
        "missing point": ["run", written(folder / "point.yaml", replaced(balance, r"point: *[^,}\n]+", "point: third_foot"))],
        "no rights to write the log": ["run", library, "--log", str(blocked / "log")],
    }


def judge(name, arguments, folder):
    """None if the output is correct, else the problem."""
    command = [FOOTFALL, *arguments, "--for", "1s", "--no-report" if "--log" in arguments else "--no-log"]
    try:
        done = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60)
    except subprocess.TimeoutExpired:
        return f"{name}: hangs"
    errors = [line for line in (done.stderr + done.stdout).splitlines() if re.search(r"\berror:", line)]
    if done.returncode not in (2, 3):
        return f"{name}: exit {done.returncode}"
    if len(errors) != 1:
        return f"{name}: {len(errors)} errors"
    return None


with scratch() as folder:
    wrong, count = [], 0
    for name, arguments in cases(Path(folder)).items():
        progress(name)
        count += 1
        problem = judge(name, arguments, folder)
        wrong += [problem] if problem else []
progress_done()
finish(f"{count - len(wrong)} of {count} answered by one error and exit 2 or 3" + "".join(f"; {w}" for w in wrong),
       not wrong)
