"""What the Python tests of the command line share: TEST.py BINARY [CLASS...], with tests/support on PYTHONPATH."""
import os
import pathlib
import socket
import subprocess
import sys
import tempfile
import unittest

BINARY = os.path.abspath(sys.argv[1])
SOURCE = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77  # exit code of a test that cannot run here

# A behavior that needs a robot and nothing else.
STAND = """behavior: 1
robot: hume
machine:
  states:
    stand:
      contacts: [right_foot, left_foot]
      tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 5}}}
"""
# One that needs no robot.
CHART = """behavior: 1
events: {go: "leaves", back: "returns"}
machine:
  states:
    a: {transitions: [{on: go, to: b}]}
    b: {transitions: [{on: back, to: a}]}
"""


def footfall(*arguments, cwd, timeout=100, **options):
    """The finished command, with what it printed."""
    return subprocess.run([BINARY, *map(str, arguments)], cwd=cwd, timeout=timeout, stdin=subprocess.DEVNULL, text=True,
                          stdout=subprocess.PIPE, stderr=options.pop("stderr", subprocess.PIPE), **options)


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("", 0))
        return probe.getsockname()[1]


class Case(unittest.TestCase):
    """A test with a folder of its own, in which its commands run."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.log = self.folder / "log"

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return str(path)

    def footfall(self, *arguments, **options):
        return footfall(*arguments, cwd=self.folder, **options)

    def run_it(self, *arguments):
        """A run whose log is self.log."""
        return self.footfall("run", *arguments, "--log", self.log, "--no-report")

    def refused(self, result, exit_code, *words):
        """One line of error with these words, and nothing was begun."""
        errors = [line for line in result.stderr.splitlines() if "error:" in line]
        self.assertEqual(len(errors), 1, result.stderr)
        self.assertEqual(result.returncode, exit_code, result.stderr)
        for word in words:
            self.assertIn(word, errors[0])
        self.assertFalse(self.log.exists(), "a log was begun")


def main(skipped=None):
    """Runs the classes that the command line names, or all; `skipped` is why they cannot run here."""
    if skipped:
        print("skipped: " + skipped)
        sys.exit(SKIPPED)
    unittest.main(module="__main__", argv=[sys.argv[0], *sys.argv[2:]])
