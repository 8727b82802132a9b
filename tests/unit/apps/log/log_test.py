"""The commands that read logs, from outside: log_test.py BINARY [CLASS...]."""
import json
import pathlib
import tempfile
import unittest

import command


class Logs(unittest.TestCase):
    """One short run and what each command says of it."""

    @classmethod
    def setUpClass(cls):
        cls.keep = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.keep.name)
        for name, seed in (("a", "3"), ("again", "3"), ("b", "4")):
            done = cls.footfall("run", "balance", "--for", "0.8s", "--seed", seed, "--quiet", "--no-report",
                                "--log", name)
            assert done.returncode == 0, done.stderr

    @classmethod
    def tearDownClass(cls):
        cls.keep.cleanup()

    @classmethod
    def footfall(cls, *arguments):
        return command.footfall(*arguments, cwd=cls.folder)

    def refused(self, result, *words):
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        for word in ("error: ", *words):
            self.assertIn(word, result.stderr)

    def test_a_log_replays_bit_for_bit(self):
        done = self.footfall("replay", "a", "--verify")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "identical: 1200 ticks\n", ""))
        done = self.footfall("replay", "a/log.mcap")
        self.assertTrue(done.stdout.startswith("replayed 1200 ticks, 0.800 s, to "), done.stdout)

    def test_a_cut_log_says_so_and_replays_as_far_as_it_goes(self):
        data = (self.folder / "a" / "log.mcap").read_bytes()
        (self.folder / "cut.mcap").write_bytes(data[:len(data) * 3 // 4])
        done = self.footfall("replay", "cut.mcap", "--verify")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("warning: the log 'cut.mcap' was cut off", done.stderr)
        self.assertLess(int(done.stdout.split()[1]), 1200)

    def test_an_estimator_tells_only_what_it_estimates(self):
        done = self.footfall("replay", "a", "--estimator", "true_state", "--from", "0s", "--json")
        said = json.loads(done.stdout)
        self.assertIsNone(said["gyro_bias_radps"])
        self.assertIsNone(said["heading_deviation_rad"]["to"])

    def test_a_value_set_twice_is_refused(self):
        self.refused(self.footfall("replay", "a", "--estimator", "contact_kalman", "--set", "estimator.foot_noise=1 mm",
                                   "--set", "estimator.foot_noise=2 mm"),
                     "'estimator.foot_noise' is set twice, to '1 mm' and to '2 mm'")

    def test_two_equal_runs_do_not_differ(self):
        self.assertEqual((self.folder / "a" / "log.mcap").read_bytes(),
                         (self.folder / "again" / "log.mcap").read_bytes())
        done = self.footfall("diff", "a", "again")
        self.assertEqual((done.returncode, done.stdout), (0, "the same: 1200 ticks\n"))

    def test_two_seeds_do(self):
        done = self.footfall("diff", "a", "b")
        self.assertEqual(done.returncode, 1)
        self.assertIn("seed: '3' against '4'", done.stdout)

    def test_a_fault_of_execution_says_where_and_what(self):
        text = ("behavior: 1\nbase: balance_best\nparameters: {gain: {value: 1, range: [0, 3]}}\nmachine:\n  transitions:\n"
                "    - {on: contact.left_foot.touchdown, do: [{set: {gain: = $gain + 1}}]}\n")
        (self.folder / "g.yaml").write_text(text)
        run = self.footfall("run", "g.yaml", "--for", "5s", "--log", "g", "--json")
        error = json.loads(run.stdout.splitlines()[-1])["execution_error"]
        self.assertIn("g.yaml:6:60: it is 4, outside 0 to 3, at ", error)
        self.assertIn(error, run.stderr)
        self.assertIn("execution  1, ", self.footfall("events", "g").stdout)
        self.assertIn("it is 4, outside 0 to 3", self.footfall("why", "g", "--at", error.split(" at ")[1]).stdout)

    def test_why_of_a_fall_names_what_fell_and_the_faults_before(self):
        run = self.footfall("run", "balance_best", "--push", "400,0.1,90,1s", "--for", "4s", "--log", "f", "--json")
        cause = json.loads(run.stdout.splitlines()[-1])["cause"]
        why = self.footfall("why", "f").stdout
        self.assertIn("end: " + cause["text"], why)
        self.assertRegex(why, r"faults of the last second:\n(  .*\n)*  .* fall ")

    def test_why_names_the_last_transition(self):
        done = self.footfall("why", "a")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("taken:\n  ", done.stdout)
        self.refused(self.footfall("why", "a", "--at", "soon"), "--at", "soon")
        self.refused(self.footfall("why", "a", "--at", "9 s"), "0 to 1199", "13500")

    def test_export_writes_what_was_asked_for(self):
        done = self.footfall("export", "a", "--csv", "--signals", "com.pos.*", "--from", "0.2s", "--to", "0.21s")
        lines = done.stdout.splitlines()
        self.assertEqual(lines[0], "tick,time,com.pos.x,com.pos.y,com.pos.z")
        self.assertEqual([line.split(",")[0] for line in lines[1:]], ["300", "306", "312"])
        self.refused(self.footfall("export", "a", "--signals", "com.poss"), "com.poss")
        events = self.footfall("export", "a", "--csv", "--events", "-o", "events.csv")
        self.assertEqual(events.returncode, 0, events.stderr)
        self.assertIn(",end,time,", (self.folder / "events.csv").read_text())

    def test_a_time_that_is_not_in_the_run_is_no_empty_answer(self):
        for command in (("export", "a", "--csv"), ("events", "a"), ("report", "a", "-o", "x.html")):
            self.refused(self.footfall(*command, "--from", "0.4s", "--to", "0.3s"), "0.3 s is before 0.4 s")
        for command in (("export", "a", "--csv"), ("events", "a")):
            self.refused(self.footfall(*command, "--from", "6s"), "the run is from 0.000 s to 0.800 s")

    def test_no_output_takes_the_place_of_what_is_read(self):
        before = (self.folder / "a" / "log.mcap").read_bytes()
        (self.folder / "link.mcap").symlink_to("a/log.mcap")
        for out in ("a/log.mcap", "link.mcap"):
            self.refused(self.footfall("export", "a", "--csv", "-o", out), "-o", "this command reads")
            self.refused(self.footfall("report", "b", "a", "-o", out), "-o", "this command reads")
            self.refused(self.footfall("report", "a", "-o", "x.html", "--strip", out), "--strip", "this command reads")
        self.assertEqual((self.folder / "a" / "log.mcap").read_bytes(), before)

    def test_what_is_no_log(self):
        (self.folder / "text.mcap").write_text("text")
        for command in (["replay"], ["why"], ["export"], ["diff", "a"]):
            self.refused(self.footfall(*command, "text.mcap"), "text.mcap")
            self.refused(self.footfall(*command, "none.mcap"), "none.mcap")


class Events(command.Case):
    def test_what_happened_by_kind_and_time(self):
        self.run_it("balance", "--for", "2s", "--quiet")
        everything = self.footfall("events", str(self.log))
        self.assertEqual((everything.returncode, everything.stderr), (0, ""))
        self.assertIn("-> step.right_foot.lift", everything.stdout)
        result = self.footfall("events", str(self.log / "log.mcap"), "--kind", "step,mark", "--from", "1s", "--to",
                               "1.8s", "--json")
        events = [json.loads(line) for line in result.stdout.splitlines()]
        self.assertEqual({e["kind"] for e in events}, {"step", "mark"})
        self.assertTrue(all(1.0 <= e["time_s"] <= 1.8 for e in events))

    def test_bad_input(self):
        self.run_it("balance", "--for", "0.1s", "--quiet")
        for arguments, word in ((["--kind", "stpe"], "step"), (["--from", "soon"], "--from")):
            result = self.footfall("events", str(self.log), *arguments)
            self.assertEqual(result.returncode, 2)
            self.assertIn(word, result.stderr)
        result = self.footfall("events", "no.mcap")
        self.assertEqual(result.returncode, 2)
        self.assertIn("no.mcap", result.stderr)


if __name__ == "__main__":
    command.main()
