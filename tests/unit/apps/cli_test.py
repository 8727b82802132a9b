"""The `footfall` command from outside: cli_test.py BINARY SOURCE_DIR [CLASS...]."""
import json
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xml.dom.minidom

BINARY, SOURCE = map(os.path.abspath, sys.argv[1:3])

STAND = """behavior: 1
robot: hume
machine:
  states:
    stand:
      contacts: [right_foot, left_foot]
      tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 5}}}
"""

CHART = """behavior: 1
events: {go: "leaves", back: "returns"}
machine:
  states:
    a: {transitions: [{on: go, to: b}]}
    b: {transitions: [{on: back, to: a}]}
"""

KEYS = """behavior robot world backend seed end steps time_s fell error foot_placement_m
max_torque_step_Nm peak_torque_Nm goal_error_m path_length_m internal_force faults tick_us
allocations real_time_factor log""".split()


class Case(unittest.TestCase):
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

    def footfall(self, *arguments):
        return subprocess.run([BINARY, *arguments], capture_output=True, text=True, timeout=100,
                              cwd=self.folder)

    def run_it(self, *arguments):
        return self.footfall("run", *arguments, "--log", str(self.log), "--no-report")

    def refused(self, result, exit_code, *words):
        errors = [line for line in result.stderr.splitlines() if "error:" in line]
        self.assertEqual(len(errors), 1, result.stderr)
        self.assertEqual(result.returncode, exit_code, result.stderr)
        for word in words:
            self.assertIn(word, errors[0])
        self.assertFalse(self.log.exists(), "a log was begun")


class BadInput(Case):
    def test_unknown_robot(self):
        self.refused(self.run_it("balance", "--robot", "huma"), 2, "huma")

    def test_unknown_robot_in_the_file(self):
        path = self.write("b.yaml", STAND.replace("hume", "huma"))
        self.refused(self.run_it(path), 2, "b.yaml:2", "huma")

    def test_missing_file(self):
        self.refused(self.run_it("no/such.yaml"), 2, "no/such.yaml")

    def test_a_folder_as_file(self):
        self.refused(self.run_it(str(self.folder)), 2)

    def test_malformed_yaml(self):
        self.refused(self.run_it(self.write("b.yaml", "behavior: 1\nrobot: [hume\n")), 2, "b.yaml:")

    def test_empty_file(self):
        self.refused(self.run_it(self.write("b.yaml", "")), 2, "b.yaml")

    def test_malformed_mjcf(self):
        robot = pathlib.Path(SOURCE, "robots/hume/robot.yaml").read_text()
        for text in ("<mujoco><worldbody></mujoco>", "", "<mujoco><worldbody/></mujoco>"):
            self.write("bad/hume.xml", text)
            path = self.write("bad/robot.yaml", robot)
            self.refused(self.run_it("balance", "--robot", path), 2)

    def test_missing_mjcf(self):
        robot = pathlib.Path(SOURCE, "robots/hume/robot.yaml").read_text()
        path = self.write("bad/robot.yaml", robot)
        self.refused(self.run_it("balance", "--robot", path), 2, "hume.xml")

    def test_a_task_on_a_missing_point(self):
        path = self.write("b.yaml", STAND.replace(
            "joint_damping,", "point_position, point: right_hand,").replace("kd: 5", "kp: 5"))
        self.refused(self.run_it(path), 2, "b.yaml:7", "right_hand")

    def test_push(self):
        for push in ("40", "40,0.1,90", "x,0.1,90,1", "40,-1,90,1", "40,0.1,90,step 0", "-4,1,0,1"):
            with self.subTest(push):
                self.refused(self.run_it("balance", "--push=" + push), 2, "--push")

    def test_more_pushes_than_there_is_room_for(self):
        pushes = ["--push=1,0.1,90,1"] * 33
        self.refused(self.run_it("balance", *pushes), 2, "--push", "33")

    def test_a_push_without_physics(self):
        self.refused(self.run_it("balance", "--backend", "stub", "--push", "40,0.1,90,1"), 2, "stub")

    def test_goal(self):
        for goal in ("1", "a,b", "1,2,3", "1 s,2 s"):
            with self.subTest(goal):
                self.refused(self.run_it("balance", "--goal", goal), 2, "--goal")

    def test_goal_velocity(self):
        self.refused(self.run_it("balance", "--goal-velocity", "fast"), 2, "--goal-velocity")

    def test_a_goal_for_a_behavior_without_one(self):
        self.refused(self.run_it(self.write("b.yaml", STAND), "--goal", "1,0"), 2, "goal")

    def test_duration(self):
        for duration in ("soon", "-3s", "0", "20 kg", "nan"):
            with self.subTest(duration):
                self.refused(self.run_it("balance", "--for=" + duration), 2, "--for")

    def test_unknown_backend(self):
        self.refused(self.run_it("balance", "--backend", "gazebo"), 2, "gazebo")

    def test_unknown_world(self):
        self.refused(self.run_it("balance", "--world", "moon"), 2, "moon")

    def test_malformed_world(self):
        self.refused(self.run_it("balance", "--world", self.write("w.yaml", "world: 1\ngruond: {}\n")),
                     2, "w.yaml:2", "gruond")

    def test_set(self):
        self.refused(self.run_it("balance", "--set", "lift_tine=150ms"), 2, "lift_tine", "lift_time")
        self.refused(self.run_it("balance", "--set", "lift_time"), 2, "lift_time")
        self.refused(self.run_it("balance", "--set", "lift_time=3s"), 2, "lift_time")

    def test_a_behavior_without_robot(self):
        self.refused(self.run_it(self.write("b.yaml", CHART)), 2, "robot")

    def test_options(self):
        self.refused(self.run_it("balance", "--fro", "3s"), 2, "--fro")
        self.refused(self.run_it("balance", "--steps", "-3"), 2, "--steps")
        self.refused(self.run_it("balance", "--log-every", "0"), 2, "--log-every", "above 0, got '0'")
        self.refused(self.run_it("balance", "--seed", "x"), 2, "--seed")
        self.refused(self.run_it("balance", "--seed=-1"), 2, "--seed")
        self.refused(self.footfall("walk"), 2)
        self.refused(self.footfall(), 2)

    def test_report_of_what_is_no_log(self):
        self.refused(self.footfall("report", "no.mcap"), 2, "no.mcap")
        self.refused(self.footfall("report", self.write("x.mcap", "text")), 2, "x.mcap")


class NoRights(Case):
    def test_a_log_that_cannot_be_written(self):
        blocked = self.write("file", "")
        for place in ("/proc/nowhere/log", blocked, blocked + "/log"):
            with self.subTest(place):
                result = self.footfall("run", "balance", "--for", "0.1s", "--log", place)
                self.refused(result, 3, place)
        self.assertEqual(pathlib.Path(blocked).read_text(), "")


class Run(Case):
    def test_json_is_the_last_line_and_has_every_key(self):
        result = self.run_it("balance", "--for", "3s", "--seed", "5", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        summary = json.loads(result.stdout.splitlines()[-1])
        for key in KEYS:
            self.assertIn(key, summary)
        self.assertEqual((summary["behavior"], summary["robot"], summary["world"]),
                         ("balance", "hume", "flat"))
        self.assertEqual((summary["backend"], summary["seed"], summary["end"]), ("mujoco", 5, "time"))
        self.assertAlmostEqual(summary["time_s"], 3.0, delta=1e-3)
        self.assertFalse(summary["fell"])
        self.assertTrue(os.path.isfile(self.folder / summary["log"]))
        for name in ("roll", "pitch", "yaw", "height"):
            self.assertLessEqual(summary["error"][name]["rms"], summary["error"][name]["max"])

    def test_every_key_of_the_summary_is_in_the_guide(self):
        result = self.run_it("balance", "--for", "0.1s", "--json", "--quiet")
        guide = pathlib.Path(SOURCE, "docs/behaviors.md").read_text()
        for key in json.loads(result.stdout):
            self.assertRegex(guide, rf"\n\| (`\w+`, )*`{key}`")

    def test_it_says_where_it_went_and_why_it_fell(self):
        result = self.run_it("balance", "--for", "5s", "--push", "800,0.2,40,0.3", "--json")
        summary = json.loads(result.stdout.splitlines()[-1])
        start, end = summary["start_m"], summary["end_m"]
        self.assertAlmostEqual(summary["moved_m"], math.dist(start, end), places=9)
        self.assertGreaterEqual(summary["path_length_m"], summary["moved_m"] - 1e-9)
        cause = summary["cause"]
        self.assertIn(cause["criterion"], ("height", "tilt", "body_contact"))
        self.assertEqual(cause["time_s"], summary["time_s"])
        for text in ("FELL", cause["text"], "moved"):
            self.assertIn(text, result.stderr)

    def test_what_the_behavior_says_is_printed(self):
        path = self.write("b.yaml", STAND.replace("stand:\n", "stand:\n      on_entry: [{log: \"stands at {time} s\"}]\n"))
        result = self.run_it(path, "--for", "0.1s")
        self.assertRegex(result.stdout, r"0\.00\d s +stands at ")
        self.assertNotIn("stands at", self.run_it(path, "--for", "0.1s", "--quiet").stdout)

    def test_a_goal_that_is_not_live_cannot_be_moved(self):
        goal = os.path.join(SOURCE, "examples/forward.yaml")
        self.refused(self.run_it(goal, "--goal", "1,0"), 2, "goal", "not live", "--set")
        self.refused(self.run_it("balance", "--goal", "1001,0"), 2, "1001", "-1000 to 1000")

    def test_quiet_json_is_one_line_and_no_log_writes_nothing(self):
        before = set(self.folder.iterdir())
        result = self.footfall("run", "balance", "--for", "0.2s", "--json", "--quiet", "--no-log")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(result.stdout.splitlines()), 1)
        self.assertIsNone(json.loads(result.stdout)["log"])
        self.assertEqual(result.stderr, "")
        self.assertEqual(set(self.folder.iterdir()), before)

    def test_the_same_seed_writes_the_same_bytes(self):
        contents = []
        for name in ("a", "b"):
            folder = self.folder / name
            self.footfall("run", "balance", "--for", "1s", "--log", str(folder), "--quiet",
                          "--no-report")
            contents.append([(folder / f).read_bytes() for f in ("log.mcap", "summary.json")])
        self.assertEqual(contents[0][0], contents[1][0])
        same = contents[0][1].replace(b"/a/", b"/b/")
        self.assertEqual(same, contents[1][1])

    def test_a_fall_is_exit_code_1(self):
        result = self.run_it("balance", "--for", "5s", "--push", "800,0.2,40,0.3", "--json", "--quiet")
        summary = json.loads(result.stdout)
        self.assertEqual((result.returncode, summary["end"], summary["fell"]), (1, "fall", True))

    def test_the_stub_backend_runs(self):
        result = self.run_it(self.write("b.yaml", STAND), "--backend", "stub", "--for", "1s", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        summary = json.loads(result.stdout.splitlines()[-1])
        self.assertEqual((summary["backend"], summary["end"], summary["steps"]), ("stub", "time", 0))
        self.assertIsNone(summary["goal_error_m"])
        self.assertIsNone(summary["foot_placement_m"])


class Interrupted(Case):
    def begin(self):
        """A run of a day, some of which is in the log already."""
        process = subprocess.Popen([BINARY, "run", "balance", "--for", "86400s", "--json",
                                    "--no-report", "--log", str(self.log)],
                                   stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.addCleanup(process.stdout.close)
        file = self.log / "log.mcap"
        end = time.monotonic() + 60
        while not (file.exists() and file.stat().st_size > 200_000):
            self.assertIsNone(process.poll(), "it ended by itself")
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)
        return process

    def report(self):
        result = self.footfall("report", str(self.log), "--no-strip", "-o", str(self.folder / "r.html"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertGreater((self.folder / "r.html").stat().st_size, 10_000)
        return result

    def test_ctrl_c_is_a_safe_stop_and_the_log_is_whole(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            process = self.begin()
            process.send_signal(number)
            out, _ = process.communicate(timeout=30)
            self.assertEqual(process.returncode, 0)
            self.assertEqual(json.loads(out.splitlines()[-1])["end"], "stopped")
            self.assertTrue((self.log / "summary.json").exists())
            self.assertNotIn("cut off", self.report().stderr)
            (self.log / "log.mcap").unlink()

    def test_a_killed_run_leaves_a_log_that_can_be_read(self):
        process = self.begin()
        process.kill()
        process.wait(timeout=30)
        self.assertIn("cut off", self.report().stderr)


class Trace(Case):
    def test_a_pure_statechart_gives_a_json_line_for_each_event(self):
        result = self.footfall("trace", self.write("c.yaml", CHART), "--events", "go,back,back,go")
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = [json.loads(line) for line in result.stdout.splitlines()]
        self.assertEqual([line["active"] for line in lines], [["a"], ["b"], ["a"], ["a"], ["b"]])

    def test_bad_input(self):
        self.refused(self.footfall("trace", "no.yaml", "--events", "go"), 2, "no.yaml")


    def test_an_event_that_nobody_knows_is_a_warning(self):
        path = self.write("c.yaml", CHART)
        result = self.footfall("trace", path, "--events", "og,go")
        self.assertEqual((result.returncode, len(result.stdout.splitlines())), (0, 3))
        self.assertRegex(result.stderr, "warning: .*'og'.*did you mean 'go'")
        self.assertEqual(self.footfall("trace", path, "--events", "go").stderr, "")


class Events(Case):
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


class Check(Case):
    def test_a_good_file(self):
        for name in ("balance", self.write("b.yaml", STAND), self.write("c.yaml", CHART)):
            result = self.footfall("check", name)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertIn("ok", result.stdout)

    def test_a_bad_file_among_good_ones(self):
        bad = self.write("b.yaml", STAND.replace("joint_damping", "joint_dampign"))
        result = self.footfall("check", "balance", bad, "balance")
        self.refused(result, 2, "b.yaml:7", "joint_damping")
        self.assertEqual(result.stdout.count("ok"), 2)

    def test_a_missing_file(self):
        self.refused(self.footfall("check", "no.yaml"), 2, "no.yaml")

    def test_physics_that_cannot_be_stops_check_and_run_before_anything_moves(self):
        turning = STAND.replace("tasks: {", "tasks: {turn: {type: body_orientation, axes: [yaw], reference: 0, "
                                "gains: {kp: 1}}, ").replace("[right_foot, left_foot]", "[right_foot]")
        bad = self.write("b.yaml", turning)
        self.refused(self.footfall("check", bad), 2, "b.yaml:7:53", "no contact can produce it")
        self.refused(self.run_it(bad), 2, "b.yaml:7:53", "no contact can produce it")
        self.assertEqual(self.footfall("trace", bad).returncode, 0)

    def test_a_warning_about_physics_is_exit_code_1_with_strict_only(self):
        bad = self.write("b.yaml", STAND.replace("tasks: {rest", "tasks: {stay").replace(
            "priority: 1,", "joints: [left_knee], priority: 1,"))
        for arguments, code in ((["check", bad], 0), (["check", "--strict", bad], 1)):
            result = self.footfall(*arguments)
            self.assertEqual(result.returncode, code, result.stderr)
            self.assertIn("warning: 4 of 5 actuated directions have no task", result.stderr)
        self.assertEqual(self.run_it(bad, "--for", "10ms").returncode, 0)


    def test_json_has_every_problem_with_its_place(self):
        bad = self.write("b.yaml", STAND.replace("joint_damping", "joint_dampign"))
        result = self.footfall("check", "--json", "balance", bad, "no.yaml")
        self.assertEqual((result.returncode, result.stderr), (2, ""))
        files = json.loads(result.stdout)["files"]
        self.assertEqual([f["ok"] for f in files], [True, False, False])
        self.assertEqual(files[0]["diagnostics"], [])
        problem = files[1]["diagnostics"][0]
        self.assertEqual((problem["severity"], problem["line"], problem["file"]), ("error", 7, bad))
        self.assertEqual(problem["column"], STAND.splitlines()[6].index("joint_damping") + 1)
        self.assertIn("joint_damping", problem["text"])

    def test_warnings_count_with_strict(self):
        path = self.write("c.yaml", CHART + "templates: {unused: {}}\n")
        result = self.footfall("check", path)
        self.assertEqual(result.returncode, 0)
        self.assertIn("warning:", result.stderr)
        self.assertEqual(self.footfall("check", "--strict", path).returncode, 1)
        files = json.loads(self.footfall("check", "--strict", "--json", path).stdout)["files"]
        self.assertEqual((files[0]["ok"], files[0]["diagnostics"][0]["severity"]), (False, "warning"))

    def test_robots_and_worlds(self):
        robot = os.path.join(SOURCE, "robots/hume/robot.yaml")
        world = os.path.join(SOURCE, "sim/worlds/flat.yaml")
        result = self.footfall("check", "--strict", robot, world)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.refused(self.footfall("check", self.write("w.yaml", "world: 1\ngruond: {}\n")), 2, "gruond")

    def test_a_world_that_runs_refuse_is_right_all_the_same(self):
        world = self.write("w.yaml", "world: 1\nactuators: {model: series_elastic}\n")
        result = self.footfall("check", world)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f"{world}:2:20: warning: ", result.stderr)
        self.assertIn("runs refuse this world", result.stderr)
        self.refused(self.run_it("balance", "--world", world), 2, "series-elastic")

    def test_a_scenario(self):
        text = "scenario: 1\nbehavior: balance\nworld: {}\nfor: 10 s\nexpect: [steps >= 10]\n"
        result = self.footfall("check", "--strict", self.write("s.yaml", text.format("flat")))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.refused(self.footfall("check", self.write("s.yaml", text.format("moon"))), 2, "s.yaml:3:8", "moon")

    def test_a_behavior_on_stdin(self):
        result = subprocess.run([BINARY, "check", "-", "--stdin-name", "mine.yaml"], text=True, timeout=100,
                                input=CHART.replace("to: b", "to: bb"), capture_output=True)
        self.refused(result, 2, "mine.yaml:5", "bb")


class Format(Case):
    UGLY = "behavior:   1   # kind\n\n\nmachine:\n    states: {a: { after: 16ms,to: b}, b: {}}\n"
    NICE = "behavior: 1  # kind\n\nmachine:\n  states: {a: {after: 16 ms, to: b}, b: {}}\n"

    def test_it_writes_in_place_and_then_there_is_nothing_to_do(self):
        path = self.write("b.yaml", self.UGLY)
        os.chmod(path, 0o640)
        self.assertEqual(self.footfall("fmt", "--check", path).returncode, 1)
        self.assertEqual(pathlib.Path(path).read_text(), self.UGLY)
        self.assertEqual(self.footfall("fmt", "--stdout", path).stdout, self.NICE)
        self.assertEqual(self.footfall("fmt", path).returncode, 0)
        self.assertEqual(pathlib.Path(path).read_text(), self.NICE)
        self.assertEqual(os.stat(path).st_mode & 0o777, 0o640)
        result = self.footfall("fmt", "--check", path)
        self.assertEqual((result.returncode, result.stdout), (0, ""))
        self.assertEqual([p.name for p in self.folder.iterdir()], ["b.yaml"])

    def test_stdin_to_stdout(self):
        result = subprocess.run([BINARY, "fmt", "-"], input=self.UGLY, capture_output=True, text=True)
        self.assertEqual((result.returncode, result.stdout), (0, self.NICE))

    def test_shipped_files_are_formatted(self):
        files = [str(f) for folder in ("behaviors", "examples", "robots", "sim")
                 for f in pathlib.Path(SOURCE, folder).rglob("*.yaml")]
        result = self.footfall("fmt", "--check", *files)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))

    def test_what_is_no_yaml_stays_as_it_is(self):
        path = self.write("b.yaml", "a: [1\n")
        self.refused(self.footfall("fmt", path), 2, "b.yaml")
        self.assertEqual(pathlib.Path(path).read_text(), "a: [1\n")
        self.refused(self.footfall("fmt", "no.yaml"), 2, "no.yaml")


class Config(Case):
    def test_the_chain_of_files_and_a_setting(self):
        self.write("a.yaml", CHART + "parameters: {n: {value: 1, doc: first}}\n")
        path = self.write("b.yaml", "base: a.yaml\nparameters:\n  n: {value: 2}\n")
        result = self.footfall("config", path, "--explain", "parameters.n.value", "--set", "n=3", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        answer = json.loads(result.stdout)
        value, = answer["values"]
        self.assertEqual((value["value"], value["file"]), ("3", "--set n"))
        self.assertEqual([(h["value"], os.path.basename(h["file"]), h["line"], h["column"])
                          for h in value["history"]], [("2", "b.yaml", 3, 14), ("1", "a.yaml", 7, 25)])
        text = self.footfall("config", path, "--explain", "parameters.n").stdout
        self.assertIn("b.yaml:3:14", text)
        self.assertIn("a.yaml:7:25", text)

    def test_a_scenario_and_what_its_keys_mean(self):
        self.write("a.yaml", CHART)
        self.write("s.yaml", "scenario: 1\nbehavior: a.yaml\nfor: 5 s\nscript: [{at: 1 s, raise: e}]\n")
        path = self.write("t.yaml", "base: s.yaml\nfor: 7 s\n")
        printed = self.footfall("config", path)
        self.assertEqual(printed.returncode, 0, printed.stderr)
        self.assertIn("for: 7 s", printed.stdout)
        text = self.footfall("config", path, "--explain", "for").stdout
        self.assertIn("t.yaml:2:6", text)
        self.assertIn("s.yaml:3:6", text)
        self.assertIn("duration of a run", text)
        self.assertIn("the default is flat", self.footfall("config", path, "--explain", "world").stdout)

    def test_what_is_printed_is_the_behavior(self):
        for name in ("balance", "balance_paper"):
            whole = self.write(name + "_whole.yaml", self.footfall("config", name).stdout)
            self.assertEqual(self.footfall("check", whole).returncode, 0)
            one, other = (self.footfall("signals", n).stdout for n in (name, whole))
            self.assertEqual(one, other)

    def test_a_state_of_a_template_and_its_place(self):
        result = self.footfall("config", "balance", "--explain", "machine.step.left_foot.lift.after")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("$lift_time", result.stdout)
        self.assertIn("balance.yaml:", result.stdout)
        self.assertIn("mirror image: stride(stance: left_foot, swing: right_foot)", result.stdout)

    def test_a_default_and_a_wrong_key(self):
        self.assertIn("default", self.footfall("config", "balance", "--explain",
                                               "parameters.dual_time.live").stdout)
        self.refused(self.footfall("config", "balance", "--explain", "gains.singel.swing"), 2, "single")
        self.refused(self.footfall("config", "balance", "--explain", "goal"), 2, "parameters.goal")
        self.refused(self.footfall("config", "balance", "--explain", "machine.step.left_fot"), 2, "left_foot")


class New(Case):
    def test_a_behavior_that_is_clean_and_runs(self):
        self.assertEqual(self.footfall("new", "behavior", "mine").returncode, 0)
        result = self.footfall("check", "--strict", "mine.yaml")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        result = self.run_it("mine.yaml", "--json", "--quiet")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertFalse(json.loads(result.stdout.splitlines()[-1])["fell"])

    def test_a_robot_that_is_clean_and_stands(self):
        self.assertEqual(self.footfall("new", "robot", "nimble").returncode, 0)
        self.assertEqual(self.footfall("new", "behavior", "mine", "--robot", "nimble").returncode, 0)
        result = self.footfall("check", "--strict", "robots/nimble/robot.yaml", "mine.yaml")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        result = self.run_it("mine.yaml", "--json", "--quiet")
        self.assertEqual(result.returncode, 0, result.stderr)
        summary = json.loads(result.stdout.splitlines()[-1])
        self.assertEqual((summary["robot"], summary["fell"]), ("nimble", False))

    def test_a_behavior_that_derives(self):
        self.assertEqual(self.footfall("new", "behavior", "mine", "--base", "balance").returncode, 0)
        text = (self.folder / "mine.yaml").read_text()
        self.assertTrue(text.startswith("base: balance\n"))
        self.assertIn("lift_time: {value: 145 ms}", text)
        (self.folder / "sub").mkdir()
        self.assertEqual(self.footfall("new", "behavior", "sub/yours", "--base", "mine.yaml").returncode, 0)
        self.assertTrue((self.folder / "sub" / "yours.yaml").read_text().startswith("base: ../mine.yaml\n"))
        result = self.footfall("check", "--strict", "mine.yaml", "sub/yours.yaml")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        result = self.footfall("new", "behavior", "x", "--base", "balanec")
        self.assertEqual(result.returncode, 2)
        self.assertIn("balanec", result.stderr)

    def test_a_chart_and_a_copy(self):
        self.assertEqual(self.footfall("new", "behavior", "c", "--from", "chart").returncode, 0)
        result = self.footfall("trace", "c.yaml", "--events", "go")
        self.assertIn('"active":["working"]', result.stdout)
        self.assertEqual(self.footfall("new", "behavior", "b", "--from", "balance").returncode, 0)
        self.assertEqual(self.footfall("check", "b.yaml").returncode, 0)

    def test_nothing_is_written_over(self):
        path = self.write("mine.yaml", "mine")
        self.refused(self.footfall("new", "behavior", "mine"), 2, "mine.yaml")
        self.assertEqual(pathlib.Path(path).read_text(), "mine")
        (self.folder / "robots" / "mine").mkdir(parents=True)
        self.refused(self.footfall("new", "robot", "mine"), 2, "robots/mine")
        self.refused(self.footfall("new", "behavior", "a b"), 2, "a b")
        self.refused(self.footfall("new", "behavior", "x", "--from", "nothing"), 2, "nothing")
        self.refused(self.footfall("new", "task", "x"), 2, "task")
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["mine.yaml", "robots"])


class Graph(Case):
    def graph(self, *arguments, **environment):
        return subprocess.run([BINARY, "graph", *arguments], capture_output=True, text=True, timeout=100,
                              cwd=self.folder, env={**os.environ, **environment})

    def test_formats_by_ending_and_by_option(self):
        path = self.write("c.yaml", CHART)
        for name, begin in (("c.dot", 'digraph "c"'), ("c.mmd", "---\ntitle")):
            result = self.graph(path, "-o", name)
            self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
            self.assertTrue((self.folder / name).read_text().startswith(begin))
        self.assertEqual(self.graph(path, "--format", "dot").stdout, (self.folder / "c.dot").read_text())

    @unittest.skipUnless(shutil.which("dot"), "Graphviz is not installed")
    def test_the_library_as_svg(self):
        for name in ("balance", "balance_best", "balance_paper"):
            result = self.graph(name, "-o", "p.svg")
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            picture = xml.dom.minidom.parse(str(self.folder / "p.svg"))
            texts = [t.firstChild.data for t in picture.getElementsByTagName("text")]
            for state in ("limp", "step", "right_foot", "left_foot", "lift", "land", "down"):
                self.assertIn(state, texts)

    def test_without_graphviz_there_is_a_message_and_dot_still_works(self):
        path = self.write("c.yaml", CHART)
        result = self.graph(path, "-o", "p.svg", PATH=str(self.folder))
        self.refused(result, 3, "graphviz", "mermaid")
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["c.yaml"])
        self.assertEqual(self.graph(path, "-o", "p.dot", PATH=str(self.folder)).returncode, 0)

    def test_bad_input(self):
        path = self.write("c.yaml", CHART)
        self.refused(self.graph(path, "-o", "p.png"), 2, "p.png")
        self.refused(self.graph("no.yaml"), 2, "no.yaml")
        self.refused(self.graph(path, "--expand", "aa", "--format", "dot"), 2, "--expand", "aa")
        self.refused(self.graph(path, "-o", "no/such/p.dot"), 3, "no/such/p.dot")


class Set(Case):
    BASE = """behavior: 1
parameters:
  t: {value: 145 ms, range: [80 ms, 400 ms], live: true}  # of a step
  goal: {value: [0, 1]}
machine: {states: {a: {after: $t, to: a}}}
"""

    def test_the_diff_is_shown_then_written_and_nothing_else_changes(self):
        path = self.write("b.yaml", self.BASE)
        result = self.footfall("set", "b.yaml", "t=0.16", "goal.y=2", "--yes")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertIn("-  t: {value: 145 ms, range", result.stdout)
        self.assertIn("+  t: {value: 160 ms, range", result.stdout)
        self.assertTrue(result.stdout.endswith("b.yaml: written\n"))
        wanted = self.BASE.replace("145 ms", "160 ms").replace("[0, 1]", "[0, 2]")
        self.assertEqual(pathlib.Path(path).read_text(), wanted)
        again = self.footfall("set", "b.yaml", "t=160ms", "goal=[0, 2]", "--yes")
        self.assertEqual((again.returncode, again.stdout), (0, "b.yaml has these values already\n"))

    def test_without_a_yes_nothing_is_written(self):
        path = self.write("b.yaml", self.BASE)
        self.assertEqual(self.footfall("set", "b.yaml", "t=0.16", "--dry-run").returncode, 0)
        result = subprocess.run([BINARY, "set", "b.yaml", "t=0.16"], capture_output=True, text=True, timeout=100,
                                cwd=self.folder, stdin=subprocess.DEVNULL)
        self.refused(result, 2, "no terminal to ask on")
        self.assertEqual(pathlib.Path(path).read_text(), self.BASE)

    def test_a_file_on_top_takes_them_instead(self):
        path = self.write("b.yaml", self.BASE)
        self.assertEqual(self.footfall("set", "b.yaml", "t=160ms", "--to", "mine.yaml", "--yes").returncode, 0)
        self.assertEqual((self.folder / "mine.yaml").read_text(),
                         "behavior: 1\nbase: b.yaml\nparameters:\n  t: {value: 160 ms}\n")
        self.assertEqual(pathlib.Path(path).read_text(), self.BASE)

    def test_bad_input(self):
        path = self.write("b.yaml", self.BASE)
        for setting, words in (("tt=1", "tt: there is no such"), ("t=1 s", "outside its range"),
                               ("t=1 N", "expected a time"), ("goal=[1]", "expected 2 values"),
                               ("t", "NAME=VALUE"), ("t=", "t"), ("t=[", "t")):
            with self.subTest(setting):
                self.refused(self.footfall("set", "b.yaml", setting, "--yes"), 2, words)
        self.refused(self.footfall("set", "none.yaml", "t=1", "--yes"), 2, "none.yaml")
        self.assertEqual(pathlib.Path(path).read_text(), self.BASE)


class Help(Case):
    def test_version(self):
        result = self.footfall("--version")
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stdout, r"^\d+\.\d+\.\d+\n$")

    def test_every_command_has_help_with_an_example(self):
        top = self.footfall("--help")
        self.assertEqual(top.returncode, 0)
        commands = [line.split()[0] for line in top.stdout.split("Subcommands:")[1].splitlines()
                    if line.strip()]
        self.assertLessEqual({"run", "check", "trace", "signals", "report", "graph", "fmt", "config", "new", "events"}, set(commands))
        for command in commands:
            with self.subTest(command):
                result = self.footfall(command, "--help")
                self.assertEqual(result.returncode, 0)
                self.assertIn("Example: footfall " + command, result.stdout)

    def test_signals_of_a_filter_parameters_and_gains(self):
        result = self.footfall("signals", "balance", "gains.single.*.kp")
        self.assertEqual(len(result.stdout.splitlines()), 3)
        self.assertRegex(result.stdout, r"gains\.single\.height\.kp +1/s\^2 +gain 270, range 0 to 800, live")
        result = self.footfall("signals", "balance", "lift_time")
        self.assertRegex(result.stdout, r"\$lift_time +s +parameter 0\.145, range 0\.08 to 0\.4, live")
        result = self.footfall("signals", "balance", "lift_tiem")
        self.assertEqual((result.returncode, result.stdout), (2, ""))

    def test_signals_have_names_and_units(self):
        result = self.footfall("signals", "balance")
        self.assertEqual(result.returncode, 0)
        names = [line.split()[0] for line in result.stdout.splitlines()]
        self.assertIn("com.pos.z", names)
        self.assertEqual(len(names), len(set(names)))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
