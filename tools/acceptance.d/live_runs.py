"""Shared by the rows of live tuning: a running engine, and client programs."""
import json
import os
import random
import signal
import subprocess
import tempfile
import time
from pathlib import Path

from rows import BUILD, FOOTFALL, ROOT, give_up, last_json

PROGRAMS = Path(os.environ.get("FOOTFALL_LIVE", BUILD / "tests" / "runs" / "live"))
GROUP = "239.255.76.67"


def some_url(group=GROUP, ttl=0):
    """A URL with a separate port, to receive no other programs' packets."""
    return f"udpm://{group}:{random.SystemRandom().randint(20000, 60000)}?ttl={ttl}"


class Engine:
    """`footfall run ... --lcm` in the background; use it in a `with`."""

    def __init__(self, behavior, *arguments, url, binary=FOOTFALL, environment=None):
        self.url = url
        self.output = tempfile.TemporaryFile("w+")
        self.errors = tempfile.TemporaryFile("w+")
        self.process = subprocess.Popen(
            [str(binary), "run", behavior, "--json", "--quiet", f"--lcm={url}", *map(str, arguments)], cwd=ROOT,
            stdin=subprocess.DEVNULL, stdout=self.output, stderr=self.errors, env=dict(os.environ, **(environment or {})))

    def __enter__(self):
        time.sleep(0.2)
        if self.process.poll() is not None:
            give_up(f"the engine ended with {self.process.returncode}: {self.said()[-300:]}")
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()

    def said(self):
        self.errors.seek(0)
        return self.errors.read().strip()

    def stop(self, timeout=120):
        """Ctrl-C; (the run's object, exit code)."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        try:
            self.process.wait(timeout)
        except subprocess.TimeoutExpired:
            raise RuntimeError("the engine did not end") from None
        self.output.seek(0)
        try:
            return last_json(self.output.read()), self.process.returncode
        except ValueError:
            raise RuntimeError(f"the engine ended with {self.process.returncode}: {self.said()[-300:]}") from None


def program(name, *arguments, url, timeout=600, before=()):
    """Runs tests/runs/live/NAME to its end; its JSON object. `before`: words in front of the command."""
    path = PROGRAMS / name
    if not path.exists():
        give_up(f"{path} is not built")
    done = subprocess.run([*before, str(path), "--url", url, *map(str, arguments)], cwd=ROOT, stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, timeout=timeout)
    if done.returncode:
        raise RuntimeError(f"{name} ended with {done.returncode}: {done.stderr.strip()[-300:]}")
    return json.loads(done.stdout.splitlines()[-1])
