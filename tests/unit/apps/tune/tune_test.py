"""`footfall tune` from outside, beside a run on a port of its own: tune_test.py BINARY [CLASS...]."""
import json
import os
import pathlib
import re
import shlex
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest

import documents
from command import BINARY, SOURCE, footfall, free_port, main

GROUP = "239.255.76.67"
NO_MULTICAST = "no multicast on this host (ip link set lo up; ip route add 239.255.76.67 dev lo)"


def multicast_works():
    """Whether a packet to the group comes back on this host."""
    port = free_port()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ear, \
            socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as mouth:
        try:
            ear.bind(("", port))
            ear.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                           struct.pack("4sl", socket.inet_aton(GROUP), socket.INADDR_ANY))
            mouth.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
            mouth.sendto(b"?", (GROUP, port))
            ear.settimeout(1.0)
            return ear.recv(8) == b"?"
        except OSError:
            return False


def without_session(text):
    """Each command names on stderr whom it talked to."""
    return re.sub(r"^session \d+: .*, pid \d+ on .*\n", "", text, flags=re.M)


class Live(unittest.TestCase):
    """A run to tune, with a copy of the library's balance_best in a folder of its own."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.file = cls.folder / "balance_best.yaml"
        shutil.copy(pathlib.Path(SOURCE, "behaviors/library/balance_best.yaml"), cls.file)
        cls.prepare()
        runtime = cls.folder / "runtime"
        runtime.mkdir(mode=0o700)
        cls.environment = dict(os.environ, XDG_RUNTIME_DIR=str(runtime), LC_ALL="C.UTF-8", TERM="xterm-256color")
        cls.environment.pop("NO_COLOR", None)
        cls.url = f"udpm://{GROUP}:{free_port()}?ttl=0"
        cls.start()

    @classmethod
    def prepare(cls):
        """What is different in the file."""

    @classmethod
    def more_options(cls):
        return []

    @classmethod
    def start(cls):
        cls.engine = subprocess.Popen(
            [BINARY, "run", str(cls.file), f"--lcm={cls.url}", "--realtime", "--for", "100s", "--no-log", "--quiet",
             *cls.more_options()], env=cls.environment, cwd=cls.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    @classmethod
    def stop(cls):
        cls.engine.send_signal(signal.SIGINT)
        cls.engine.communicate(timeout=20)

    @classmethod
    def tearDownClass(cls):
        cls.stop()
        cls.temporary.cleanup()

    def tune(self, *arguments, **options):
        return footfall("tune", "--url", self.url, "--timeout", "20s", *arguments, env=self.environment, cwd=self.folder,
                        **options)

    def good(self, *arguments):
        result = self.tune(*arguments)
        self.assertEqual((result.returncode, without_session(result.stderr)), (0, ""), result.stdout)
        return result.stdout

    def refused(self, code, *arguments):
        result = self.tune(*arguments)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        self.assertEqual(result.stdout, "")
        return without_session(result.stderr).splitlines()


class Commands(Live):
    @classmethod
    def prepare(cls):
        text = cls.file.read_text()
        cls.file.write_text(text.replace("machine:\n", "events: {wave: \"somebody waves\"}\nmachine:\n", 1))

    def test_set_get_undo_save(self):
        """One after the other in one run: each start of a run costs."""
        text = self.good("set", "lift_time=150ms", "gains.single.place.kp[1]=240", "--raise", "wave")
        self.assertRegex(text, r"^accepted at tick \d+, revision 1: ")
        self.assertEqual(self.good("get", "lift_time", "gains.single.place.kp"),
                         "lift_time=150 ms\ngains.single.place.kp=[220, 240] 1/s^2\n")
        told = json.loads(self.good("diff", "--json"))
        self.assertEqual([(p["name"], p["file"], p["target"]) for p in told["parameters"]],
                         [("lift_time", 0.145, 0.15), ("gains.single.place.kp", [220, 237], [220, 240])])
        self.assertEqual(told["revision"], 1)
        # Refused whole: nothing of it is done, and each reason is a line.
        reasons = self.refused(1, "set", "land_time=160ms", "lift_time=3s", "gains.single.swing.kp=-1")
        self.assertEqual(len(reasons), 2, reasons)
        self.assertTrue(all(line.startswith("refused: ") for line in reasons))
        self.assertIn("revision 0 was expected", self.refused(1, "set", "lift_time=151ms", "--revision", "0")[0])
        self.assertEqual(self.good("get", "land_time"), "land_time=150 ms\n")
        before = self.file.read_text()
        self.assertIn("+  lift_time: {value: 150 ms", self.good("save", "--dry-run"))
        self.assertEqual(self.file.read_text(), before)
        self.assertIn("--yes", self.refused_save())
        self.good("save", "--yes")
        changed = [(a, b) for a, b in zip(before.splitlines(), self.file.read_text().splitlines()) if a != b]
        self.assertEqual([b.split("}")[0].split("live")[0] for _, b in changed][0],
                         "  lift_time: {value: 150 ms, range: [80 ms, 200 ms], ")
        self.assertEqual(len(changed), 2)
        self.assertEqual(self.good("diff"), "")
        self.assertIn("has these values already", self.good("save"))
        self.good("undo")
        self.assertEqual(self.good("diff").split(), ["lift_time", "150", "ms", "->", "145", "ms",
                                                    "gains.single.place.kp", "[220,", "240]", "1/s^2", "->", "[220,",
                                                    "237]", "1/s^2"])
        self.assertIn("nothing to undo", " ".join(self.refused(1, "undo")).lower())
        self.good("redo")
        self.good("raise", "wave")

    def refused_save(self):
        result = self.tune("save")
        self.assertEqual(result.returncode, 2, result.stderr)
        return result.stderr

    def test_bad_input(self):
        self.assertEqual(self.refused(2, "set", "lift_tine=1", "goal=20kg"),
                         ["error: unknown parameter 'lift_tine' (did you mean 'lift_time'?)",
                          "error: goal: expected a length, got '20kg'"])
        self.assertEqual(self.refused(2, "set", "clearance=9cm", "height=1m"),
                         ["error: 'clearance' is not live, because the file does not say so: give it a range and "
                          "'live: true'", "error: 'height' is not live, because the behavior's actions set it"])
        self.assertIn("goal.x=1m sets one", self.refused(2, "set", "goal=1m")[0])
        self.assertIn("did you mean 'wave'", self.refused(2, "raise", "wafe")[0])
        self.assertIn("matches", self.refused(2, "list", "nothing*")[0])
        self.assertIn("did you mean 'com.pos.z'", self.refused(2, "watch", "com.pos.zz")[0])
        self.assertIn("needs a terminal", self.refused(2)[0])

    def test_watch(self):
        watcher = subprocess.Popen([BINARY, "tune", "--url", self.url, "--timeout", "20s", "watch", "--json", "com.pos.z",
                                    "lift_time"], env=self.environment, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        samples = []
        while len(samples) < 5:
            told = json.loads(watcher.stdout.readline())
            if "com.pos.z" in told:  # else somebody's edit
                samples.append(told)
        watcher.send_signal(signal.SIGINT)
        _, errors = watcher.communicate(timeout=20)
        self.assertEqual((watcher.returncode, without_session(errors)), (0, ""))
        self.assertTrue(all(0.8 < one["com.pos.z"] < 1.0 and one["lift_time"] > 0.1 for one in samples))
        self.assertEqual(sorted(samples, key=lambda one: one["tick"]), samples)
        self.assertIn("state", self.good("watch", "--for", "10ms").splitlines()[0])


    def test_watch_prints_a_ramp_beside_its_times_for_as_long_as_asked(self):
        begin = self.good("ramp", "gains.single.swing.kp=480", "--over", "8s")
        tick = int(re.match(r"accepted at tick (\d+)", begin)[1])
        rows = [json.loads(line) for line in self.good("watch", "gains.single.swing.kp", "--json", "--for",
                                                       "400ms").splitlines()]
        self.good("undo", "--over", "1ms")
        self.assertGreater(len(rows), 10)
        self.assertLessEqual(rows[-1]["time_s"] - rows[0]["time_s"], 0.4 + 1e-6)
        self.assertGreater(rows[-1]["time_s"] - rows[0]["time_s"], 0.35)
        for row in rows:  # 10 a second from 400 on
            self.assertAlmostEqual(row["gains.single.swing.kp"], 400 + 10 * (row["tick"] - tick) / 1500, delta=0.02)


class Saves(Live):
    """Beside a run with --set, by hands in the file."""

    @classmethod
    def more_options(cls):
        return ["--set", "land_time=152ms"]

    def edit(self, old, new):
        text = self.file.read_text()
        self.assertIn(old, text)
        self.file.write_text(text.replace(old, new))

    def test_what_somebody_edited_meanwhile_is_not_overwritten(self):
        self.good("set", "lift_time=150ms")
        self.good("save", "--yes")  # of --set, too
        self.assertIn("land_time: {value: 152 ms", self.file.read_text())
        self.good("set", "lift_time=155ms")
        self.good("save", "--yes")  # its own value is nobody's edit
        self.edit("lift_time: {value: 155 ms", "lift_time: {value: 149 ms")
        self.good("set", "lift_time=160ms", "land_time=155ms")
        for how in (["--yes"], ["--dry-run"], ["--to", str(self.file), "--yes"]):
            lines = self.refused(2, "save", *how)
            self.assertEqual(len(lines), 1, lines)
            self.assertIn("lift_time: the file was edited since the last save: it has 149 ms now, had 155 ms", lines[0])
        self.assertIn("lift_time: {value: 149 ms", self.file.read_text())
        self.good("save", "land_time", "--yes")  # what is not edited
        self.assertIn("it has 149 ms now", self.refused(2, "save", "--yes")[0])
        self.good("save", "--to", str(self.folder / "mine.yaml"), "--yes")
        self.assertIn("160 ms", (self.folder / "mine.yaml").read_text())
        self.edit("lift_time: {value: 149 ms", "lift_time: {value: 160 ms")  # as the run has it
        self.assertIn("has these values already", self.good("save", "--yes"))


class Ends(Live):
    """Last: it ends its run."""

    def test_an_edit_before_the_first_save_is_not_overwritten(self):
        self.good("set", "lift_time=150ms")
        text = self.file.read_text()
        self.file.write_text(text.replace("lift_time: {value: 145 ms", "lift_time: {value: 140 ms"))
        self.assertIn("lift_time: the file was edited while the run was on: it has 140 ms now, had 145 ms",
                      self.refused(2, "save", "--yes")[0])
        self.file.write_text(text)
        self.good("save", "--yes")

    def test_watch_ends_well_when_the_run_does(self):
        watcher = subprocess.Popen([BINARY, "tune", "--url", self.url, "--timeout", "20s", "watch", "com.pos.z"],
                                   env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        watcher.stdout.readline()
        self.engine.send_signal(signal.SIGINT)
        _, errors = watcher.communicate(timeout=20)
        self.assertEqual(watcher.returncode, 0, errors)
        self.assertRegex(without_session(errors), r"^the run has ended after [\d.]+ s\n$")


class TwoEngines(Live):
    """A second run at the address of the first."""

    def test_a_command_asks_which_and_reaches_that_one_only(self):
        def number(text, pid):
            return re.search(rf"pid {pid} .* session (\d+)$", text, flags=re.M)[1]

        self.good("list")
        second = subprocess.Popen(
            [BINARY, "run", str(self.file), f"--lcm={self.url}", "--realtime", "--for", "100s", "--no-log"],
            env=self.environment, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        try:
            self.assertIn("warning: another engine is at", second.stdout.readline())
            self.assertIn(f"footfall tune --url '{self.url}'", second.stdout.readline())
            both = self.good("list-engines")
            self.assertEqual(len(both.splitlines()), 2, both)
            lines = self.refused(1, "set", "lift_time=146ms")
            self.assertEqual([line.split(":")[0] for line in lines],
                             ["error"] + [f"  --session {number(both, p.pid)}" for p in (self.engine, second)])
            for process, value in ((self.engine, "146 ms"), (second, "147 ms")):
                chosen = ["--session", number(both, process.pid)]
                self.assertIn("revision 1:", self.good(*chosen, "set", f"lift_time={value}"))
            for process, value in ((self.engine, "146 ms"), (second, "147 ms")):
                chosen = ["--session", number(both, process.pid)]
                self.assertEqual(self.good(*chosen, "get", "lift_time"), f"lift_time={value}\n")
            gone = footfall("tune", "--url", self.url, "--session", "1000000000", "--timeout", "1s", "list",
                            env=self.environment, cwd=self.folder)
            self.assertEqual(gone.returncode, 3)
            self.assertIn("list-engines", gone.stderr)
        finally:
            second.send_signal(signal.SIGINT)
            second.communicate(timeout=20)


class Silence(unittest.TestCase):
    def test_without_an_engine_it_says_what_to_check(self):
        with tempfile.TemporaryDirectory() as folder:
            result = subprocess.run(
                [BINARY, "tune", "--url", f"udpm://{GROUP}:{free_port()}?ttl=0", "--timeout", "0.3s", "list"],
                env=dict(os.environ, XDG_RUNTIME_DIR=folder), capture_output=True, text=True, timeout=20)
        self.assertEqual(result.returncode, 3)
        self.assertIn("no engine answers", result.stderr)

    def test_what_cannot_be_an_address_or_a_key(self):
        for arguments, word in ((["--url", "http://x"], "http"), (["--key", "/no/such.key"], "/no/such.key"),
                                (["--timeout", "soon"], "soon"), (["--prefix", "A B"], "A B")):
            with self.subTest(arguments):
                result = subprocess.run([BINARY, "tune", *arguments, "list"], capture_output=True, text=True,
                                        timeout=20)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(word, result.stderr)
                self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)

    def test_a_key_is_made_once_and_for_its_owner(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "robot.key")
            made = subprocess.run([BINARY, "tune", "key", path], capture_output=True, text=True, timeout=20)
            self.assertEqual((made.returncode, made.stderr), (0, ""))
            self.assertEqual(os.stat(path).st_mode & 0o777, 0o600)
            again = subprocess.run([BINARY, "tune", "key", path], capture_output=True, text=True, timeout=20)
            self.assertEqual(again.returncode, 2)


class Document(Live):
    """Every `footfall tune` of a console block in docs/tuning.md prints what it says there."""

    def test_the_commands_of_the_document(self):
        failures, count = [], 0
        # `check` of a saved overlay: the original's warnings are not the matter here.
        for language, line, lines in documents.blocks(pathlib.Path(SOURCE, "docs/tuning.md").read_text()):
            if language != "console":
                continue
            for command, expected in commands_of(lines):
                words = shlex.split(command)
                if words[1] == "tune":
                    words[2:2] = ["--url", self.url]
                done = footfall(*words[1:], cwd=self.folder, env=self.environment, stderr=subprocess.STDOUT)
                count += 1
                if not documents.matches(expected, without_session(done.stdout).splitlines()):
                    failures.append(f"{line}: {command}\nexpected\n" + "\n".join(expected) + "\ngot\n" + done.stdout)
        self.assertEqual(failures, [], "\n".join(failures))
        self.assertGreater(count, 15)


def commands_of(lines):
    """(command, lines that it prints) of a console block."""
    found = []
    for line in lines:
        if line.startswith("$ "):
            found.append((line[2:], []))
        elif found:
            found[-1][1].append(line)
    return found


class Completion(Live):
    def complete(self, line):
        """What bash offers at the end of the line."""
        script = f"""
            source {shlex.quote(str(SOURCE))}/tools/completion/footfall.bash
            compopt() {{ :; }}
            COMP_LINE={shlex.quote(line)}
            COMP_WORDS=({line}{' ""' if line.endswith(' ') else ''})
            COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1))
            COMP_WORDS[0]={shlex.quote(BINARY)}
            _footfall
            printf '%s\\n' "${{COMPREPLY[@]}}"
        """
        done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, timeout=60, env=self.environment,
                              cwd=self.folder)
        self.assertEqual(done.stderr, "")
        return done.stdout.split()

    def test_commands_options_files_and_names(self):
        self.assertEqual(self.complete("footfall tu"), ["tune"])
        self.assertIn("run", self.complete("footfall "))
        self.assertEqual(self.complete("footfall tune und"), ["undo"])
        self.assertIn("--lcm", self.complete("footfall run --lc"))
        self.assertEqual(self.complete("footfall tune set --ov"), ["--over"])
        self.assertEqual(self.complete("footfall check balance_b"), ["balance_best.yaml"])
        engine = f"--url {shlex.quote(self.url)}"
        self.completes(f"footfall tune {engine} get lift_t", "lift_time")
        self.completes(f"footfall tune {engine} set la", "land_time=")
        self.completes(f"footfall tune {engine} set gains.single.s", "gains.single.swing.kp=")

    def completes(self, line, name):
        """Completion gives up after a second: a busy machine is asked again."""
        deadline = time.monotonic() + 20.0
        while name not in (offered := self.complete(line)):
            self.assertLess(time.monotonic(), deadline, f"{line}: {offered}")


if __name__ == "__main__":
    main(skipped=NO_MULTICAST if sys.argv[2:] != ["Silence"] and not multicast_works() else None)
