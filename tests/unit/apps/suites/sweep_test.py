"""`footfall sweep` with children that pass, fall, crash, hang and talk nonsense: sweep_test.py BINARY [CLASS...]."""
import collections
import os
import pathlib
import re
import signal
import sqlite3
import subprocess
import time

from command import BINARY, SOURCE, Case, main

FAKE = str(pathlib.Path(__file__).with_name("fake_run.sh").resolve())
VARY = ["--vary", "lift_time=130ms..160ms:2"]


class SweepCase(Case):
    def setUp(self):
        super().setUp()
        self.out = self.folder / "out"
        self.environment = dict(os.environ, FAKE_LOG=str(self.folder / "starts"), FAKE_ACTS="")

    def command(self, *arguments, what="balance_best"):
        program = [] if "--program" in arguments else ["--program", FAKE]
        return [BINARY, "sweep", what, *program, "-j", "2", "--out", str(self.out), *arguments]

    def start(self, command):
        return subprocess.Popen(command, cwd=SOURCE, env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                stdin=subprocess.DEVNULL, text=True)

    def run_it(self, command, expect=0):
        process = self.start(command)
        self.stdout, self.stderr = process.communicate(timeout=60)
        self.assertEqual(process.returncode, expect, self.stdout + self.stderr)

    def sweep(self, *arguments, expect=0, **more):
        self.run_it(self.command(*arguments, **more), expect)

    def rows(self, columns, path=None):
        database = sqlite3.connect(path or self.out / "sweep.sqlite")
        try:
            return database.execute(f"SELECT {columns} FROM runs WHERE id IS NOT NULL ORDER BY id").fetchall()
        finally:
            database.close()

    def starts(self):
        path = self.folder / "starts"
        return path.read_text().splitlines() if path.exists() else []


class Refused(SweepCase):
    def test_an_axis_that_the_start_overwrites_is_refused(self):
        self.sweep("--vary", "height=[0.8, 0.9]", "--seeds", "1", expect=2)
        self.assertRegex(self.stderr, r"error: height changes nothing: the entry of 'sway' sets 'height'.*balance_best.yaml:\d+")
        self.assertEqual(self.starts(), [])

    def test_a_time_below_zero_is_refused_at_its_value(self):
        self.sweep("--vary", "sway_time=[-1 s, 1 s]", expect=2)
        self.assertIn("--vary sway_time:1:", self.stderr)
        self.assertIn("is -1 s: expected a time from 0 s", self.stderr)

    def test_seeds_that_draw_nothing_are_warned_of_and_others_are_not(self):
        said = "2 seeds are one run 2 times: in world 'ideal' a seed draws nothing"
        self.sweep("--worlds", "ideal", "--seeds", "1..2")
        self.assertIn(said, self.stderr)
        self.environment["FAKE_LOG"] = str(self.folder / "others")
        self.out = self.folder / "out2"
        self.sweep("--worlds", "flat", "--seeds", "1..2")
        self.assertEqual(self.stderr, "")
        self.out = self.folder / "out3"
        self.sweep("--worlds", "ideal", "--seeds", "1")
        self.assertEqual(self.stderr, "")


class Children(SweepCase):
    def test_each_end_of_a_child_is_a_recorded_result_and_no_other_run_suffers(self):
        self.environment["FAKE_ACTS"] = "crash@2 fall@3 garbage@4 input@5 machine@6 hang@7"
        self.sweep("--seeds", "1..8", "--timeout", "0.8s", expect=1)
        self.assertEqual([s for (s,) in self.rows("status")], ["passed", "crashed", "failed", "bad_output", "bad_input",
                                                               "machine", "timed_out", "passed"])
        tails = dict(self.rows("seed, error_tail"))
        self.assertIn("about to crash", tails[2])
        self.assertIn("it is wrong", tails[5])
        self.assertIn("8/8 runs, 1 failed, 5 broken", self.stdout)
        first = self.stdout[self.stdout.index("  broken       run 1: "):]  # and why, and how to see it
        self.assertIn("about to crash", first.splitlines()[1])
        self.assertRegex(first, r"\n    rerun      footfall run .*--seed 2\b")

    def test_a_child_gets_its_parameters_and_what_it_says_becomes_figures(self):
        self.sweep(*VARY, "--seeds", "1..2", "--for", "5s", "--world", "slippery")
        command = self.rows("command")[3][0]
        for words in ("--seed 2", "'lift_time=160 ms'", "--for 5s", "sim/worlds/slippery.yaml"):
            self.assertIn(words, command)
        self.assertIn("--no-log", self.starts()[0])
        database = sqlite3.connect(self.out / "sweep.sqlite")
        row = database.execute('SELECT lift_time, steps, "error.pitch.max" FROM results WHERE id = 3').fetchone()
        database.close()
        self.assertEqual(row, ("160 ms", 2.0, 0.02))
        self.assertIn("lift_time", (self.out / "report.html").read_text())

    def test_a_program_that_cannot_be_started_ends_the_sweep_and_leaves_its_runs_to_do(self):
        self.sweep("--seeds", "1..4", "--program", str(self.folder / "gone"), expect=3)
        self.assertIn("could not be started", self.stderr)
        self.assertEqual({s for (s,) in self.rows("status")}, {"pending"})

    def test_falls_alone_are_no_failure_of_the_sweep(self):
        self.environment["FAKE_ACTS"] = "fall@1"
        self.sweep("--seeds", "1..2")


class Resume(SweepCase):
    def test_an_interrupted_sweep_goes_on_without_repeating_what_is_done(self):
        self.environment["FAKE_ACTS"] = " ".join(f"slow@{n}" for n in range(1, 9))
        process = self.start(self.command("--seeds", "1..8"))
        time.sleep(0.7)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=20)
        self.assertEqual(process.returncode, 1, out + err)
        self.assertIn("repeat the command to continue", out)
        done = [seed for seed, status in self.rows("seed, status") if status == "passed"]
        self.assertGreater(len(done), 0)
        self.assertLess(len(done), 8)
        begun = len(self.starts())
        self.sweep("--seeds", "1..8")
        self.assertEqual({s for (s,) in self.rows("status")}, {"passed"})
        self.assertEqual(len(self.starts()) - begun, 8 - len(done))

    def test_kill_9_loses_the_runs_in_flight_at_most(self):
        self.environment["FAKE_ACTS"] = " ".join(f"slow@{n}" for n in range(1, 9))
        process = self.start(self.command("--seeds", "1..8"))
        time.sleep(0.7)
        process.kill()
        process.communicate()
        done = {seed for seed, status in self.rows("seed, status") if status == "passed"}
        self.sweep("--seeds", "1..8")
        self.assertEqual({s for (s,) in self.rows("status")}, {"passed"})
        times = collections.Counter(line.split("--seed ")[1].split()[0] for line in self.starts())
        self.assertEqual([n for n in done if times[str(n)] != 1], [])
        self.assertLessEqual(sum(times.values()), 8 + 2)

    def test_a_finished_sweep_starts_nothing(self):
        self.sweep("--seeds", "1..2")
        self.sweep("--seeds", "1..2")
        self.assertEqual(len(self.starts()), 2)
        self.assertIn("0/0 runs (2 done before)", self.stdout)

    def test_another_plan_is_refused_and_extend_keeps_what_it_shares(self):
        self.sweep("--seeds", "1..2")
        self.sweep("--seeds", "1..3", expect=2)
        self.assertIn("--extend", self.stderr)
        self.sweep("--seeds", "1..3", "--extend")
        self.assertEqual(len(self.starts()), 3)

    def test_a_changed_behavior_is_refused(self):
        copy = self.folder / "mine.yaml"
        text = pathlib.Path(SOURCE, "behaviors/library/balance_best.yaml").read_text()
        copy.write_text(text.replace("base: ", f"base: {SOURCE}/behaviors/library/"))
        self.sweep("--seeds", "1", what=str(copy))
        copy.write_text(copy.read_text() + "\n# a remark\n")
        self.sweep("--seeds", "1", what=str(copy), expect=2)
        self.assertIn("has changed since", self.stderr)


class Input(SweepCase):
    def test_bad_names_and_values_are_told_before_the_first_run(self):
        for arguments, words in ((["--vary", "lift_tme=[1 s]"], "did you mean 'lift_time'"),
                                 (["--vary", "lift_time=[9 s]"], "outside the range"),
                                 (["--vary", "lift_time=1ms..150ms:5"], "outside the range"),
                                 (["--vary", "lift_time=[5 N]"], "expected a time"),
                                 (["--vary", "script.1.push.force=[5 N]"], "needs a scenario"),
                                 (["--world", "nowhere"], "unknown world"),
                                 (["--vary", "world.ground.friction=[-1]"], "world.ground.friction"),
                                 (["--faults", "none,mocap.gone"], "mocap.dropout"),
                                 (["--faults", "mocap.dropout@90s", "--for", "5s"], "behind the end"),
                                 (["--figure", "error.picth.max"], "did you mean 'error.pitch.max'"),
                                 (["--vary", "goal.x=[1 m]", "--vary", "goal=[[0 m, 0 m]]"], "given values twice"),
                                 (["--count", "5"], "give --sample"),
                                 (["--shard", "3/2"], "--shard")):
            self.sweep(*arguments, expect=2)
            self.assertIn(words, self.stderr, arguments)
        self.assertEqual(self.starts(), [])

    def test_a_file_says_where_it_is_wrong(self):
        path = self.folder / "s.yaml"
        path.write_text("sweep: 1\nbehavior: balance_best\nvary:\n  lift_time: [150 ms, 9 s]\n")
        for command in ([BINARY, "check", str(path)], self.command(what=str(path))):
            self.run_it(command, expect=2)
            self.assertIn(f"{path}:4:23: error:", self.stderr)

    def test_a_scenario_takes_the_parameters_that_a_sweep_gives_it(self):
        path = self.folder / "s.yaml"
        path.write_text("scenario: 1\nbehavior: balance_best\nfor: 0.1 s\n"
                        "script: [{at: 0.05 s, push: {force: 20 N, for: 10 ms}}]\n")
        run = [BINARY, "run", str(path), "--no-log", "--quiet", "--set"]
        self.run_it([*run, "lift_time=150 ms"])
        self.run_it([*run, "lift_tme=150 ms"], expect=2)
        self.assertIn("did you mean 'lift_time'", self.stderr)
        self.sweep("--vary", "script.1.push.force=[10 N, 30 N]", what=str(path))
        forces = [pathlib.Path(line.split()[1]).read_text() for line in self.starts()]
        self.assertTrue(any("force: 30 N" in text for text in forces), forces)
        self.sweep("--vary", "script.2.push.force=[10 N]", what=str(path), expect=2)
        self.assertIn("N from 1 to 1", self.stderr)

    def test_a_draw_of_the_world_that_the_scenario_sets_itself_is_refused_and_the_scenarios_own_varies(self):
        path = self.folder / "s.yaml"
        path.write_text("scenario: 1\nbehavior: balance_best\nfor: 0.1 s\nvariation: {friction: 0.5}\n")
        for name in ("world.variation.friction", "world.ground.friction"):
            self.sweep("--vary", name + "=[0.4,0.9]", what=str(path), expect=2)
            self.assertIn(f"'{name}' has no effect: the scenario's `variation:` goes over it; vary 'variation.friction'",
                          self.stderr)
        self.sweep("--vary", "variation.friction=[0.4,0.9]", "--vary", "world.variation.friction=[0.4]", what=str(path), expect=2)
        self.sweep("--vary", "world.variation.start.joints=[0.01]", what=str(path))
        self.out = self.folder / "own"
        self.environment["FAKE_LOG"] = str(self.folder / "own_starts")
        self.sweep("--vary", "variation.friction=[0.4,0.9]", what=str(path))
        starts = (self.folder / "own_starts").read_text().splitlines()
        texts = [pathlib.Path(line.split()[1]).read_text() for line in starts]
        self.assertEqual([f"friction: {x}" in text for x, text in zip((0.4, 0.9), sorted(texts))], [True, True], texts)

    def test_the_friction_of_the_ground_is_that_of_the_runs(self):
        self.run_it([BINARY, "sweep", "balance_best", "--vary", "world.ground.friction=[0.6,0.9]", "--for", "50ms",
                     "--out", str(self.out)])
        for path, friction in zip(sorted((self.out / "files").glob("world-*.yaml"), key=lambda p: p.read_text()), (0.6, 0.9)):
            self.run_it([BINARY, "run", "balance_best", "--world", str(path), "--for", "50ms", "--no-log"])
            self.assertIn(f"friction {friction}, feet", self.stdout)
            self.assertNotIn("friction", self.stdout.split("drawn")[1].split("\n")[0])

    def test_save_writes_a_file_with_the_same_plan(self):
        path = self.folder / "s.yaml"
        self.sweep(*VARY, "--seeds", "1..2", "--save", str(path))
        self.sweep(*VARY, "--seeds", "1..2")
        self.sweep(what=str(path))
        self.assertIn("0/0 runs (4 done before)", self.stdout)

    def test_a_full_disk_is_told_as_the_machines_refusal(self):
        command_line = ["sh", "-c", 'ulimit -f 4; exec "$@"', "-", *self.command(*VARY)]
        self.run_it(command_line, expect=3)
        self.assertIn("sweep.sqlite: disk I/O error", self.stderr)

    def test_list_prints_every_command(self):
        self.sweep(*VARY, "--seeds", "1..3", "--list")
        self.assertEqual(len(self.stdout.splitlines()), 6)
        self.sweep(*VARY, "--seeds", "9,2..3", "--list")  # as `test` takes them
        self.assertEqual([re.search(r"--seed (\d+)", line)[1] for line in self.stdout.splitlines()], list("923923"))
        self.assertEqual(self.starts(), [])


class Shards(SweepCase):
    def test_shards_join_to_what_one_sweep_gives(self):
        for shard in (1, 2, 3):
            self.sweep(*VARY, "--seeds", "1..4", "--shard", f"{shard}/3")
        self.assertEqual(len(self.starts()), 8)
        self.run_it([BINARY, "sweep", "--merge", str(self.out)])
        self.assertIn("8 of 8 runs", self.stdout)
        self.assertEqual({s for (s,) in self.rows("status")}, {"passed"})
        self.run_it([BINARY, "sweep", "--csv", str(self.out)])
        self.assertEqual(len((self.out / "sweep.csv").read_text().splitlines()), 9)

    def test_a_missing_shard_is_told_and_the_same_command_can_fill_it(self):
        self.sweep("--seeds", "1..4", "--shard", "1/2")
        self.run_it([BINARY, "sweep", "--merge", str(self.out)], expect=1)
        self.assertIn("2 of 4 runs", self.stdout)

    def test_the_slurm_script_submits_an_array_and_a_merge_after_it(self):
        tools = self.folder / "bin"
        tools.mkdir()
        # Runs each task at once, as Slurm would some time.
        (tools / "sbatch").write_text('#!/bin/bash\nscript=$(cat)\necho "$@" >>"$SBATCH_LOG"\n'
                                      'last=$(grep -oP -- "--array=1-\\K\\d+" <<<"$script" || echo 1)\n'
                                      'for k in $(seq "$last"); do SLURM_ARRAY_TASK_ID=$k SLURM_CPUS_PER_TASK=1 '
                                      'bash -c "$script" >>"$SBATCH_LOG.out" 2>&1; done\necho 17\n')
        (tools / "sbatch").chmod(0o755)
        self.environment.update(PATH=f"{tools}:{os.environ['PATH']}", SBATCH_LOG=str(self.folder / "sbatch"))
        command = self.command(*VARY, "--seeds", "1..3", "--slurm", "2", "-j", "1")
        command.remove("-j"), command.remove("2")
        self.run_it(command)
        script = (self.out / "slurm.sh")
        script.write_text(script.read_text().replace(" --no-report", f" --no-report --program {FAKE}")
                          .replace(FAKE + " sweep", BINARY + " sweep"))
        self.run_it(["bash", str(script), "--partition=x"])
        self.assertIn("merge:  job 17", self.stdout)
        calls = (self.folder / "sbatch").read_text()
        self.assertIn("--dependency=afterany:17", calls)
        self.assertEqual(calls.count("--partition=x"), 2)
        self.assertEqual({s for (s,) in self.rows("status")}, {"passed"}, (self.folder / "sbatch.out").read_text())
        self.assertEqual(len(self.starts()), 6)


if __name__ == "__main__":
    main()
