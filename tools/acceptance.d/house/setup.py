#!/usr/bin/env python3
"""How many packages tools/demo installs on a Debian that has nothing but the required ones and apt."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import re
import subprocess

from rows import ROOT, finish, give_up, scratch

MOST = 185


def output(command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        give_up(f"{' '.join(map(str, command[:2]))} failed: {done.stderr.strip()[-200:]}")
    return done.stdout


def stanzas():
    """{package: its fields} of all that apt knows for this machine; the first version of each."""
    found = {}
    for text in output(["apt-cache", "dumpavail"]).split("\n\n"):
        fields = dict(re.findall(r"^([A-Z][\w-]*): (.*)$", text, flags=re.M))
        if fields.get("Architecture") in ("amd64", "arm64", "all") and fields.get("Package") not in found:
            found[fields["Package"]] = fields
    return found


def alternatives(fields, keys):
    """[[name, ...], ...]: of each dependency its alternatives."""
    groups = [g for key in keys for g in re.split(r",\s*", fields.get(key, "")) if g]
    return [[re.split(r"[ (:]", a.strip())[0] for a in g.split("|")] for g in groups]


def minimal(packages):
    """The names of the required packages, apt, and what they depend on."""
    providers = {}
    for name, fields in packages.items():
        for group in alternatives(fields, ["Provides"]):
            providers.setdefault(group[0], []).append(name)
    left = [n for n, f in packages.items() if f.get("Priority") == "required" or f.get("Essential") == "yes"] + ["apt"]
    found = set()
    while left:
        name = left.pop()
        if name not in packages:
            if name in providers and not found & set(providers[name]):
                left.append(providers[name][0])
            continue
        if name in found:
            continue
        found.add(name)
        for names in alternatives(packages[name], ["Pre-Depends", "Depends"]):
            if not found & set(names):
                left.append(next((n for n in names if n in packages or n in providers), names[0]))
    return found


packages = stanzas()
wanted = [line.split()[0] for line in (ROOT / "tools/dependencies.txt").read_text(encoding="utf-8").splitlines()
          if line.strip() and not line.startswith("#") and " test " not in f" {line.split('#')[0]} "]
with scratch() as folder:
    status = Path(folder) / "status"
    with open(status, "w", encoding="utf-8") as out:
        for name in sorted(minimal(packages)):
            kept = {k: v for k, v in packages[name].items() if k in ("Package", "Version", "Architecture", "Multi-Arch", "Depends",
                                                                     "Pre-Depends", "Provides", "Maintainer")}
            out.write("".join(f"{k}: {v}\n" for k, v in kept.items()) + "Status: install ok installed\nDescription: -\n\n")
    plan = output(["apt-get", "-s", "-o", f"Dir::State::status={status}", "-o", "APT::Install-Recommends=0",
                   "-o", "Debug::NoLocking=1", "install", *wanted])
count = len(re.findall(r"^Inst ", plan, flags=re.M))
finish(f"{count} packages for tools/demo", 0 < count <= MOST)
