#!/usr/bin/env python3
"""Cases near those that are known, with the right outcome, written by somebody who did not write the mends:
tests/silent/neighbours.json. Each runs in a fresh folder. `--only TEXT`: cases of a row, or whose name has it."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import base64
import json
import os
import signal
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor

from rows import FOOTFALL, PROCESSES, ROOT, finish, progress, progress_done

# @SOURCE@ in the data is the root of this tree.
DATA = json.loads((ROOT / "tests" / "silent" / "neighbours.json").read_text().replace("@SOURCE@", str(ROOT)))
PROGRAM = str(Path(FOOTFALL).resolve())


def content(value):
    """Bytes of a file: a text, bytes in base64, or one of the shared texts, perhaps with a change."""
    if isinstance(value, str):
        return value.encode()
    if "base64" in value:
        return base64.b64decode(value["base64"])
    text = DATA["texts"][value["same"]]
    return (text.replace(*value["change"]) if "change" in value else text).encode()


def run(case):
    """What was seen, and why it is wrong; no reasons: it is right."""
    with tempfile.TemporaryDirectory(prefix="neighbour-") as folder:
        for name, value in case["files"].items():
            path = Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content(value))
        # Output goes to a file, so that a child left in the background cannot keep us waiting.
        with tempfile.TemporaryFile() as output:
            process = subprocess.Popen(["bash", "-c", case["shell"]], cwd=folder, env=dict(os.environ, F=PROGRAM),
                                       stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT, start_new_session=True)
            limit = 3 * case.get("seconds", 10)  # two run at a time
            try:
                code = process.wait(limit)
            except subprocess.TimeoutExpired:
                code = None
            try:
                os.killpg(process.pid, signal.SIGKILL)  # only the group that this case began
            except ProcessLookupError:
                pass
            process.wait()
            output.seek(0)
            seen = output.read().decode(errors="replace")
    reasons = []
    if code is None:
        reasons.append(f"not over after {limit} s")
    elif code not in case["exit"]:
        reasons.append(f"exit code {code}, not {case['exit']}")
    reasons += [f"does not say {text!r}" for text in case.get("says", []) if text not in seen]
    reasons += [f"says {text!r}" for text in case.get("not", []) if text in seen]
    return reasons, seen


cases = DATA["cases"]
if "--only" in sys.argv:
    only = sys.argv[sys.argv.index("--only") + 1]
    cases = [c for c in cases if c["row"] == only or only in c["name"]]
right = 0
with ThreadPoolExecutor(PROCESSES) as pool:
    for number, (case, (reasons, seen)) in enumerate(zip(cases, pool.map(run, cases)), 1):
        progress(f"{number} of {len(cases)} cases")
        right += not reasons
        if reasons:
            progress_done()
            print(f"{case['row']} {case['name']}\n  {case['shell'][:300]}\n  {'; '.join(reasons)}", file=sys.stderr)
            print("\n".join("    | " + line[:200] for line in seen.splitlines()[:6]), file=sys.stderr)
progress_done()
finish(f"{right} of {len(cases)}", right == len(cases) and right >= 60, right >= 120)
