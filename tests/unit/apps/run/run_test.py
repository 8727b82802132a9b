"""`footfall run` from outside: run_test.py BINARY [CLASS...]."""
import json
import math
import os
import pathlib
import re
import signal
import subprocess
import time

from command import BINARY, CHART, SOURCE, STAND, Case, main

KEYS = """behavior robot world backend seed end steps time_s fell error foot_placement_m
max_torque_step_Nm peak_torque_Nm goal_error_m path_length_m internal_force faults fault_ticks variation format tick_us
allocations real_time_factor log""".split()

# At 98 N on each foot 32 N need a friction of 0.33.
STANDS_APART = """behavior: 1
robot: hume
machine:
  contacts: [right_foot, left_foot]
  tasks:
    height: {type: com_position, axes: [z], priority: 1, reference: entry, gains: {kp: 270, kd: 10}}
    attitude: {type: body_orientation, priority: 1, reference: 0, gains: {kp: 200, kd: 15}}
    rest: {type: joint_damping, priority: 2, gains: {kd: 2}}
  internal: {s: {between: [right_foot, left_foot], reference: 32 N}}
  states:
    stand: {after: 100 ms, to: end}
    end: {type: final}
"""


HANGS = """behavior: 1
robot: hume
machine:
  contacts: []
  tasks: {posture: {type: joint_posture, priority: 1, gains: {kp: 800, kd: 57}, reference: {trajectory: hold}}}
  states: {hang: {after: 20 ms, to: end}, end: {type: final}}
"""


class World(Case):
    def test_sensor_errors_that_nothing_reads_are_told_once(self):
        path = self.write("b.yaml", STAND)
        for world, estimator, errors in (("flat", "true_state", "none"), ("lab", "true_state", "unused"),
                                         ("lab", "contact_kalman", "used")):
            arguments = ["run", path, "--world", world, "--set", f"estimator.type={estimator}", "--for", "20ms", "--no-log"]
            said = self.footfall(*arguments)
            self.assertEqual(said.stdout.count(f"  estimator    {estimator}"), 1)
            self.assertEqual(said.stdout.count("of 'lab' do not reach the state"), int(errors == "unused"), said.stdout)
            summary = json.loads(self.footfall(*arguments, "--json").stdout)
            self.assertEqual((summary["estimator"], summary["sensor_errors"]), (estimator, errors))
            self.assertEqual(self.footfall(*arguments, "--quiet").stdout, "")

    def test_a_robot_that_nothing_holds_at_the_start_is_a_warning(self):
        path = self.write("b.yaml", HANGS)
        for world, warned in (("flat", 1), ("harness", 0), ("hoist", 0)):
            said = self.footfall("run", path, "--world", world, "--no-log", "--quiet")
            self.assertEqual(said.stderr.count("relies on no contact"), warned, said.stderr)
        said = self.footfall("run", path, "--backend", "stub", "--no-log", "--quiet")
        self.assertNotIn("relies on no contact", said.stderr)
        scenario = "scenario: 1\nbehavior: b.yaml\nfor: 20 ms\n"
        self.assertIn("warning: 'hang' begins", self.footfall("check", self.write("s.yaml", scenario)).stderr)
        held = self.write("h.yaml", scenario + "script: [{at: 0 s, hold: torso}]\n")
        self.assertNotIn("relies on no contact", self.footfall("check", held).stderr)


class BadInput(Case):
    def test_unknown_robot(self):
        self.refused(self.run_it("balance", "--robot", "huma"), 2, "huma")

    def test_unknown_robot_in_the_file(self):
        path = self.write("b.yaml", STAND.replace("hume", "huma"))
        self.refused(self.run_it(path), 2, "b.yaml:2", "huma")

    def test_missing_file(self):
        self.refused(self.run_it("no/such.yaml"), 2, "no/such.yaml")

    # Of four markers in 200 ms, each seen in a hundredth of the time and hidden for 100 s.
    def test_a_start_that_motion_capture_never_sees(self):
        path = self.write("b.yaml", STAND.replace("robot: hume", "robot: hume\nestimator: {type: motion_capture}"))
        world = self.write("w.yaml", "world: 1\nsensors:\n  mocap: {occlusion: 99 %, spell: 100 s}\n")
        run = self.footfall("run", path, "--world", world, "--no-log")
        self.assertEqual(run.returncode, 2)
        for words in ("w.yaml:3:22: error: no state at the start", "markers at most", "another seed"):
            self.assertIn(words, run.stderr)

    # The default world has 0.7 at least, slippery 0.3.
    def test_the_friction_of_the_world_is_that_of_the_check(self):
        path = self.write("b.yaml", STANDS_APART)
        self.assertEqual(self.footfall("run", path, "--quiet", "--no-log").returncode, 0)
        self.refused(self.run_it(path, "--world", "slippery"), 2, "b.yaml:9:", "friction of the world")
        scenario = self.write("s.yaml", "scenario: 1\nbehavior: b.yaml\nworld: slippery\nfor: 50 ms\nexpect: [faults == 0]\n")
        self.refused(self.run_it(scenario), 2, "friction of the world")

    def test_variation_off_is_judged_with_the_friction_that_it_uses(self):
        low = self.write("low.yaml", "world: 1\nvariation: {friction: {range: [0.2, 1]}}\n")
        path = self.write("b.yaml", STANDS_APART)
        self.refused(self.run_it(path, "--world", low), 2, "friction of the world")
        self.assertEqual(self.footfall("run", path, "--world", low, "--variation", "off", "--no-log", "--quiet").returncode, 0)
        scenario = self.write("s.yaml", f"scenario: 1\nbehavior: b.yaml\nworld: {low}\nfor: 50 ms\nexpect: [faults == 0]\n")
        self.refused(self.run_it(scenario), 2, "friction of the world")
        self.assertEqual(self.footfall("run", scenario, "--variation", "off", "--no-log", "--quiet").returncode, 0)

    def test_a_drawn_push_behind_the_end_is_told_and_fails_nothing(self):
        path = self.write("s.yaml", "scenario: 1\nbehavior: balance_best\nfor: 50 ms\nworld: varied\nexpect: [{end: time}]\n")
        check = self.footfall("check", path)
        self.assertIn("s.yaml:3:6: warning: no push is drawn before 3 s, and the run ends at 0.05 s", check.stderr)
        result = self.footfall("run", path, "--no-log", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        run = json.loads(result.stdout.splitlines()[-1])["figures"]
        told = f"push at {run['variation']['push.time_s']:.3g} s"
        self.assertEqual((run["missed"], run["not_reached"]), ([], [told]))
        self.assertIn(told + ": not reached", result.stderr)

    def test_off_in_a_derived_scenario_takes_away_what_the_world_draws(self):
        self.write("s.yaml", "scenario: 1\nbehavior: balance_best\nfor: 50 ms\nvariation: {friction: 0.5}\n")
        path = self.write("d.yaml", "scenario: 1\nbase: s.yaml\nvariation: off\n")
        result = self.footfall("run", path, "--no-log", "--json")
        self.assertEqual(json.loads(result.stdout.splitlines()[-1])["figures"]["variation"], {}, result.stderr)

    def test_the_world_of_a_base_lies_beside_the_base(self):
        self.write("low/w.yaml", "world: 1\nground: {friction: 0.5}\n")
        self.write("low/s.yaml", "scenario: 1\nbehavior: balance_best\nworld: w.yaml\nfor: 50 ms\n")
        path = self.write("d.yaml", "scenario: 1\nbase: low/s.yaml\n")
        for command in (["run", path, "--no-log", "--quiet"], ["check", path], ["sweep", path, "--seeds", "1", "--out", str(self.folder / "o")]):
            result = self.footfall(*command)
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_a_link_that_the_robot_lacks_is_told_where_it_is_named(self):
        for key in ("variation: {control_model: {com: {torsoo: {sd: 5 mm}}}}", "control_model: {com: {torsoo: [1 mm, 0 m, 0 m]}}"):
            self.write("v.yaml", f"world: 1\n{key}\n")
            world = str(self.folder / "v.yaml")
            scenario = self.write("s.yaml", "scenario: 1\nbehavior: balance_best\nworld: v.yaml\nfor: 50 ms\n")
            place = f"v.yaml:2:{key.index('torsoo') + 1}: error: the robot has no body 'torsoo' (did you mean 'torso'?)"
            self.refused(self.run_it("balance_best", "--world", world), 2, place)
            self.refused(self.run_it(scenario), 2, place)
            self.refused(self.footfall("check", scenario), 2, place)
            for what in (["balance_best", "--world", world], [scenario]):
                self.refused(self.footfall("sweep", *what, "--seeds", "1", "--for", "50ms", "--out", str(self.folder / "o")), 2, place)

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

    def test_a_duration_below_one_tick_runs_nothing(self):
        self.refused(self.run_it("balance", "--for", "0.1ms"), 2, "--for", "a tick of 'hume', 0.667 ms, got '0.1ms'")

    def test_a_film_that_is_no_mp4_is_refused_before_the_run(self):
        result = self.footfall("run", "balance", "--for", "2s", "--film", "x.gif")
        self.refused(result, 2, "--film: error: expected a file named *.mp4", "x.gif")
        self.assertFalse((self.folder / "out").exists())

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

    def test_a_name_that_is_set_twice(self):
        self.refused(self.run_it("balance", "--set", "lift_time=150ms", "--set", "lift_time=140ms"), 2,
                     "--set: error: 'lift_time' is set twice, to '150ms' and to '140ms'")
        for whole, part in (("goal=[0.1, 0]", "goal.x=0.2"), ("gains.single.swing.kp=250", "gains.single.swing.kp[0]=300")):
            self.refused(self.run_it("balance", "--set", whole, "--set", part), 2, "are both set: expected one of them")

    def test_set_of_a_variable_that_the_start_overwrites_is_warned_of(self):
        result = self.run_it("balance_best", "--set", "height=0.95m", "--for", "10ms")
        self.assertRegex(result.stderr, r"balance_best.yaml:\d+:\d+: warning: --set height changes nothing: the entry of 'sway'")

    def test_set_of_a_time_below_zero_is_refused(self):
        self.refused(self.run_it("balance_best", "--set", "sway_time=-400ms"), 2, "--set sway_time:1:1",
                     "is -400 ms: expected a time from 0 s")

    def test_a_list_of_too_few_gains_is_no_decimal_comma(self):
        result = self.run_it("balance", "--set", "gains.single.swing.kp=[300,200]")
        self.refused(result, 2, "expected 3 values (x, y, z), got 2")
        self.assertNotIn("comma", result.stderr)

    def test_an_edit_that_set_would_refuse_is_refused_when_the_scenario_is_loaded(self):
        text = ("scenario: 1\nbehavior: balance_best\nfor: 1 s\nscript:\n  - {at: 100 ms, edit: {lift_time: 190 ms}}\n"
                "  - {at: 200 ms, edit: {land_time: %s}}\nexpect: [{never: in(limp)}]\n")
        path = self.write("s.yaml", text % "190 ms")  # each alone would do
        words = ("s.yaml:6:", "with these values planner 'foot' diverges")
        self.refused(self.run_it(path), 2, *words)
        self.refused(self.footfall("check", path), 2, *words)
        self.assertEqual(self.footfall("check", self.write("t.yaml", text % "160 ms")).returncode, 0)
        self.refused(self.footfall("check", self.write("u.yaml", text.replace("land_time", "goal") % "1 m")), 2,
                     "u.yaml:6:", "expected 2 values for 'goal'", "goal.x")

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
        result = self.run_it("balance", "--for", "3s", "--seed", "6", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        summary = json.loads(result.stdout.splitlines()[-1])
        for key in KEYS:
            self.assertIn(key, summary)
        self.assertEqual((summary["behavior"], summary["robot"], summary["world"]),
                         ("balance", "hume", "flat"))
        self.assertEqual((summary["backend"], summary["seed"], summary["end"]), ("mujoco", 6, "time"))
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

    def test_a_push_that_never_came_is_exit_code_1(self):
        push = "40,0.1,90,step 16 phase 0.5"
        result = self.run_it("balance", "--for", "0.1s", "--push", push, "--json")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(json.loads(result.stdout.splitlines()[-1])["missed"], [push])
        self.assertIn("NEVER CAME", result.stderr)

    def test_delay_and_model_error_of_the_world_are_in_the_summary(self):
        for world, words in (("delay_2ms", "command delay 2 ms"), ("mass_plus_10", "model mass +10 %")):
            result = self.footfall("run", "balance_best", "--world", world, "--for", "50ms", "--no-log")
            self.assertRegex(result.stdout, rf"(?m)^  physics .*, {re.escape(words)}$")

    def test_latest_leads_to_a_run_that_is_there(self):
        latest = self.folder / "out/run/latest"
        for _ in range(2):
            self.footfall("run", "balance", "--for", "20ms", "--quiet", "--no-report")
        runs = sorted(p for p in latest.parent.iterdir() if not p.is_symlink())
        self.assertEqual(len(runs), 2)
        latest.unlink()
        latest.symlink_to(runs[0].name)
        self.footfall("runs", "prune", "--keep", "1", "--yes")
        self.assertEqual(os.readlink(latest), runs[1].name)
        self.footfall("runs", "prune", "--keep", "0", "--yes")
        self.assertFalse(os.path.lexists(latest))

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
        summary = json.loads(self.run_it("balance", "--backend", "stub", "--for", "0.3s", "--json", "--quiet").stdout)
        self.assertEqual((summary["backend"], summary["fell"]), ("stub", False))
        self.assertGreaterEqual(summary["time_s"], 0.299)


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


if __name__ == "__main__":
    main()
