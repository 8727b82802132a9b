#!/usr/bin/env python3
"""Damaged packets on every channel that the engine listens to, under AddressSanitizer: only counted rejections, and the
next honest edit is answered. From another network namespace, joined by a cable: forged edits are refused for lack of the
key; recorded ones are not executed again, and refused by the next run. Needs root for the namespace."""
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from live_runs import Engine, program, some_url
from rows import BEST, ROOT, finish, give_up, progress, progress_done, scratch

PACKETS = int(os.environ.get("FOOTFALL_ATTACK_PACKETS", "1000000"))  # received on each channel
RATE = 6000  # packets a second on each channel
SENT_MORE = 1.1  # the network itself loses some packets of such a flood
ASAN = ROOT / "build" / "asan" / "apps" / "footfall"
EDITS = 40  # recorded edits
NAMESPACE, OURS, THEIRS = "footfall-attack", "ffattack0", "ffattack1"
GROUP = "239.255.77.68"


def build():
    for step in (["cmake", "--preset", "asan"], ["cmake", "--build", "--preset", "asan", "--target", "footfall"]):
        done = subprocess.run(step, cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if done.returncode:
            give_up(f"{' '.join(step)} failed: {done.stdout[-300:]}")


def flood(key):
    """(packets received on the channel with fewer, rejections by reason, problems)."""
    url = some_url()
    sent = int(PACKETS * SENT_MORE)
    with Engine(BEST, "--for", "100000s", "--no-log", "--lcm-key", key, url=url, binary=ASAN,
                environment={"ASAN_OPTIONS": "detect_leaks=0:exitcode=99"}) as engine:
        program("live_attack", "--key", key, "--count", sent, "--datagrams", sent // 10, "--rate", RATE, url=url,
                timeout=sent * 1.1 / RATE + 600)
        honest = program("live_edits", "--key", key, "--count", 20, "--rate", 20, url=url)
        run, code = engine.stop()
        said = engine.said()
    live = run["live"]
    problems = [] if code == 0 and "AddressSanitizer" not in said else [f"the engine ended with {code}: {said[-300:]}"]
    if live["applied"] != honest["accepted"] or honest["unanswered"] or not honest["accepted"]:
        problems.append(f"{live['applied']} edits applied, {honest['accepted']} of them honest")
    return min(live["packets"].values()), live["rejected"], problems


class Cable:
    """A network namespace and a cable to it that carries GROUP."""

    def __enter__(self):
        inside = ["ip", "netns", "exec", NAMESPACE]
        steps = [["ip", "netns", "add", NAMESPACE], ["ip", "link", "add", OURS, "type", "veth", "peer", "name", THEIRS],
                 ["ip", "link", "set", THEIRS, "netns", NAMESPACE], ["ip", "addr", "add", "10.213.77.1/30", "dev", OURS],
                 ["ip", "link", "set", OURS, "up"], ["ip", "route", "add", GROUP, "dev", OURS],
                 [*inside, "ip", "link", "set", "lo", "up"], [*inside, "ip", "addr", "add", "10.213.77.2/30", "dev", THEIRS],
                 [*inside, "ip", "link", "set", THEIRS, "up"], [*inside, "ip", "route", "add", GROUP, "dev", THEIRS]]
        for step in steps:
            done = subprocess.run(step, capture_output=True, text=True)
            if done.returncode:
                self.__exit__()
                give_up(f"no network namespace here: {' '.join(step)}: {done.stderr.strip()}")
        return inside

    def __exit__(self, *_):
        for step in (["ip", "netns", "del", NAMESPACE], ["ip", "link", "del", OURS]):
            subprocess.run(step, capture_output=True)


def from_elsewhere(folder, key):
    """Result of forged and recorded edits: (text, problems)."""
    url, problems, recording = some_url(GROUP, ttl=1), [], str(Path(folder) / "edits.lcm")
    engine_options = (BEST, "--realtime", "--for", "600s", "--no-log", "--lcm-key", key)
    with Cable() as inside:
        play = [*inside, "lcm-logplayer", f"--lcm-url={url}", "--speed=1", recording]
        with Engine(*engine_options, url=url) as engine:
            honest = program("live_edits", "--key", key, "--count", 5, "--rate", 20, url=url, before=inside)
            program("live_attack", "--key", key, "--count", 0, "--forge", 500, "--rate", 500, url=url, before=inside)
            logger = subprocess.Popen([*inside, "lcm-logger", "-f", f"--lcm-url={url}", "--channel=FOOTFALL_REQUEST",
                                       recording], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(0.5)
            recorded = program("live_edits", "--key", key, "--count", EDITS, "--rate", 50, url=url)
            time.sleep(0.5)
            logger.send_signal(signal.SIGINT)
            logger.wait(20)
            subprocess.run(play, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=120)
            time.sleep(0.5)
            first, _ = engine.stop()
        with Engine(*engine_options, url=url) as engine:
            time.sleep(1.0)
            subprocess.run(play, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=120)
            time.sleep(0.5)
            second, _ = engine.stop()
    live, again = first["live"], second["live"]
    if not honest["accepted"]:
        problems.append("with the key nothing passed the cable")
    if live["rejected"]["not_authentic"] < 450:
        problems.append(f"only {live['rejected']['not_authentic']} forged edits were heard")
    if live["applied"] != honest["accepted"] + recorded["accepted"]:
        problems.append(f"{live['applied']} edits applied instead of {honest['accepted'] + recorded['accepted']}")
    if live["repeated"] < EDITS // 2:
        problems.append(f"only {live['repeated']} recorded edits were heard again")
    if again["applied"] or again["refused"] < EDITS // 2:
        problems.append(f"in the next run {again['applied']} recorded edits were applied, {again['refused']} refused")
    return (f"from another namespace {live['rejected']['not_authentic']} forged edits refused, {live['repeated']} recorded "
            f"ones not done again, {again['refused']} refused by the next run"), problems


with scratch() as top:
    key_file = Path(top) / "shared.key"
    key_file.write_text(os.urandom(32).hex() + "\n", encoding="utf-8")
    key_file.chmod(0o600)
    try:
        progress("building under AddressSanitizer")
        if not os.environ.get("FOOTFALL_NO_BUILD"):
            build()
        progress(f"{PACKETS} damaged packets on each channel")
        heard, rejected, wrong = flood(str(key_file))
        progress("another network namespace")
        text, more = from_elsewhere(top, str(key_file))
    except (RuntimeError, OSError, subprocess.TimeoutExpired) as problem:
        give_up(problem)
    progress_done()
wrong += more + ([] if heard >= PACKETS else [f"only {heard} packets were heard on a channel"])
reasons = ", ".join(f"{count} {name.replace('_', ' ')}" for name, count in rejected.items() if count)
finish(f"{heard} damaged packets on each channel under ASan: {reasons}; {text}; {wrong[0] if wrong else 'nothing else happened'}",
       not wrong)
