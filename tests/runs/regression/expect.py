"""Runs a behavior and compares the figures of its summary with what is expected of them.

expect.py BINARY [--seeds A-B] BEHAVIOR [RUN OPTIONS...] -- EXPECTATION...
An expectation is PATH OPERATOR VALUE, e.g. 'steps>=57', 'error.pitch.max<=0.005', 'fell==false',
'mean_speed_last_50_mps.0>=0.18'. Prints every figure asked for. Exit: 0 all met, 1 not, 2 usage.
"""
import json
import operator
import re
import subprocess
import sys

OPERATORS = {"<=": operator.le, ">=": operator.ge, "==": operator.eq, "!=": operator.ne,
             "<": operator.lt, ">": operator.gt}


def parsed(text):
    match = re.fullmatch(r"([\w.]+)\s*(<=|>=|==|!=|<|>)\s*(.+)", text)
    if not match:
        sys.exit(f"expect.py: error: '{text}' is not PATH OPERATOR VALUE")
    try:
        value = json.loads(match[3])
    except json.JSONDecodeError:
        value = match[3]
    return match[1], match[2], value


def figure(summary, path):
    for key in path.split("."):
        if summary is None:
            return None
        summary = summary[int(key)] if isinstance(summary, list) else summary.get(key)
    return summary


def met(value, symbol, wanted):
    if value is None and wanted is not None:
        return False  # a figure that does not apply meets nothing
    return OPERATORS[symbol](value, wanted)


def run(binary, options, expectations):
    command = [binary, "run", *options, "--json", "--quiet", "--no-log"]
    result = subprocess.run(command, capture_output=True, text=True)
    print("$", *command)
    if result.returncode not in (0, 1):  # 1: the robot failed, and the figures say how
        print(result.stderr)
        return False
    summary = json.loads(result.stdout.splitlines()[-1])
    good = True
    for path, symbol, wanted in expectations:
        value = figure(summary, path)
        ok = met(value, symbol, wanted)
        print(f"  {'pass' if ok else 'FAIL'}  {path} = {json.dumps(value)}   ({symbol} {json.dumps(wanted)})")
        good &= ok
    if not good:
        print(json.dumps(summary, indent=1))
    return good


def main(arguments):
    if "--" not in arguments or len(arguments) < 3:
        print(__doc__)
        return 2
    split = arguments.index("--")
    binary, options = arguments[0], arguments[1:split]
    expectations = [parsed(text) for text in arguments[split + 1:]]
    seeds = [None]
    if options[0] == "--seeds":
        first, last = options[1].split("-")
        seeds, options = range(int(first), int(last) + 1), options[2:]
    good = [run(binary, options + ([] if seed is None else ["--seed", str(seed)]), expectations)
            for seed in seeds]
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
