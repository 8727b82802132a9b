"""The commands that read, change and make behaviors, from outside: behavior_test.py BINARY [CLASS...]."""
import json
import os
import pathlib
import shutil
import subprocess
import unittest
import xml.dom.minidom

from command import BINARY, CHART, SOURCE, STAND, Case, main


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

    def test_a_folder_hides_no_name(self):
        for name in ("lab", "balance", "hume"):
            self.write(f"{name}/other.txt", "")
            for command in ("check", "config"):
                result = self.footfall(command, name)
                self.assertEqual((result.returncode, result.stderr), (0, ""), name)
        self.write("nothing/other.txt", "")
        self.refused(self.footfall("check", "nothing"), 2, "nothing", "directory")

    def test_a_world_says_what_only_a_robot_judges(self):
        rope = "{to: [0 m, 0 m, 4 m], length: 2 m, stiffness: %s}"
        base = self.write("w/base.yaml", "world: 1\nconstraints:\n  aid:\n    body: torso\n    rope: " +
                          rope % "20 kN/m" + "\n")
        over = self.write("w/over.yaml", "# A remark.\n\nworld: 1\nbase: base.yaml\nconstraints:\n"
                          "  aid: {rope: {stiffness: 1e10 N/m}}\n")
        said = self.footfall("check", over)
        self.assertEqual((said.returncode, said.stderr), (0, ""))
        self.assertIn("over.yaml: ok; --robot NAME judges its bodies, constraints", said.stdout)
        files = json.loads(self.footfall("check", "--json", over, "ideal").stdout)["files"]
        self.assertEqual([f["not_judged"] for f in files], ["bodies, constraints", ""])
        self.refused(self.footfall("check", "--robot", "hume", over), 2, "over.yaml:6:27", "the rope of 'torso' stably")
        self.assertEqual(self.footfall("check", "--robot", "hume", base).stdout.strip(), f"{base}: ok")
        self.refused(self.footfall("check", "--robot", "huem", base), 2, "did you mean 'hume'?")

    def test_a_robot_is_given_to_behaviors_and_worlds_only(self):
        self.refused(self.footfall("check", "--robot", "hume", "hume"), 2, "--robot", "'hume' is a robot")
        self.assertEqual(self.footfall("check", "--robot", "hume", self.write("b.yaml", STAND)).returncode, 0)

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

    def test_worlds_and_robots_have_names_too(self):
        for name in ("varied", "hume", "balance"):
            self.assertEqual(self.footfall("check", name).returncode, 0, name)
            self.assertEqual(self.footfall("config", name).returncode, 0, name)
        self.refused(self.footfall("check", "vared"), 2, "no behavior, world or robot of this name", "did you mean 'varied'?")
        path = self.write("mine.yaml", "world: 1\nbase: varied\nground: {friction: 0.5}\n")
        self.assertEqual(self.footfall("check", path).returncode, 0)
        run = self.footfall("run", "balance", "--world", path, "--for", "10ms", "--no-log", "--json")
        self.assertIn("command_delay_s", json.loads(run.stdout.splitlines()[-1])["variation"], run.stderr)
        path = self.write("other.yaml", "base: vared\nground: {friction: 0.5}\n")
        self.refused(self.footfall("run", "balance", "--world", path), 2, "no 'vared.yaml' in a sim/worlds", "did you mean 'varied'?")

    def test_what_physics_finds_in_a_base_is_told_at_the_value_that_it_follows_from(self):
        path = self.write("o.yaml", "behavior: 1\nbase: balance_best\nparameters:\n  land_time: {value: 151 ms}\n  clearance: {value: 6}\n")
        result = self.footfall("check", path)
        self.assertEqual(result.returncode, 2)
        self.assertIn("o.yaml:5:22: error: task 'swing' asks for a foot at a height of 6 m", result.stderr)
        self.assertRegex(result.stderr, r"\(found at \S*balance_best\.yaml:\d+:\d+\)")
        self.assertEqual(result.stderr.count("error:"), 1)
        for setting, kind in (("clearance=6", "error"), ("planners.foot.width_offset=10cm", "warning")):
            name = setting.split("=")[0]
            result = self.footfall("run", "balance_best", "--set", "land_time=151ms", "--set", setting, "--for", "10ms", "--no-log", "--quiet")
            self.assertIn(f"--set {name}:1:1: {kind}: ", result.stderr)

    def test_robots_and_worlds(self):
        robot = os.path.join(SOURCE, "robots/hume/robot.yaml")
        world = os.path.join(SOURCE, "sim/worlds/flat.yaml")
        result = self.footfall("check", "--strict", robot, world)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.refused(self.footfall("check", self.write("w.yaml", "world: 1\ngruond: {}\n")), 2, "gruond")

    def test_a_world_that_runs_refuse_is_right_all_the_same(self):
        world = self.write("w.yaml", "world: 1\nactuators: {coulomb: 1 Nm}\n")
        result = self.footfall("check", world)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f"{world}:2:22: warning: ", result.stderr)
        self.assertIn("runs refuse this world", result.stderr)
        self.refused(self.run_it("balance", "--world", world), 2, "no effect on ideal actuators")

    def test_a_scenario(self):
        text = "scenario: 1\nbehavior: balance\nworld: {}\nfor: 10 s\nexpect: [steps >= 10]\n"
        result = self.footfall("check", "--strict", self.write("s.yaml", text.format("flat")))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.refused(self.footfall("check", self.write("s.yaml", text.format("moon"))), 2, "s.yaml:3:8", "moon")

    def test_gains_that_a_drawn_delay_makes_unstable_are_refused(self):
        # One period late, x' = -kd x is stable below 1 / T = 1500 1/s.
        quick = self.write("b.yaml", STAND.replace("priority: 1", "joints: [left_knee], priority: 1").replace("kd: 5", "kd: 2000"))
        late = self.write("w.yaml", "world: 1\nvariation: {command_delay: 667 us}\n")
        prompt = self.write("p.yaml", "world: 1\n")
        scenario = "scenario: 1\nbehavior: b.yaml\nworld: {}\nfor: 10 ms\nexpect: [time >= 0 s]\n"
        said = "kd 2000 1/s is too much for a period of 0.667 ms and a delay of 0.667 ms"
        self.refused(self.run_it(quick, "--world", late, "--for", "10ms"), 2, said)
        drawn = self.write("s.yaml", scenario.format("p.yaml") + "variation: {command_delay: {range: [0 s, 667 us]}}\n")
        for path in (drawn, self.write("t.yaml", scenario.format("w.yaml"))):
            self.refused(self.footfall("check", path), 2, said)
            self.refused(self.run_it(path), 2, said)
        self.assertEqual(self.footfall("check", self.write("u.yaml", scenario.format("p.yaml"))).returncode, 0)
        told = json.loads(self.run_it("balance", "--world", "varied", "--for", "10ms", "--json").stdout)["variation"]
        self.assertIn(round(told["command_delay_s"] * 3000, 6), (0, 1, 2))  # whole steps of the physics
        off = self.run_it(quick, "--world", late, "--for", "10ms", "--variation", "off")
        self.assertEqual(off.returncode, 0, off.stderr)

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

    def test_what_a_base_has_is_written_as_an_override_unless_the_base_is_meant(self):
        base = self.write("b.yaml", self.BASE)
        top = self.write("top.yaml", "# mine\nbase: b.yaml\n")
        self.assertEqual(self.footfall("set", "top.yaml", "t=160ms", "--yes").returncode, 0)
        self.assertEqual(pathlib.Path(base).read_text(), self.BASE)
        self.assertEqual(pathlib.Path(top).read_text(), "# mine\nbase: b.yaml\nparameters:\n  t: {value: 160 ms}\n")
        self.assertEqual(self.footfall("set", "top.yaml", "goal.y=2", "--into-base", "--yes").returncode, 0)
        self.assertIn("[0, 2]", pathlib.Path(base).read_text())
        self.write("gait.yaml", "base: balance_best\n")
        self.refused(self.footfall("set", "gait.yaml", "lift_time=150ms", "--into-base", "--yes"), 2, "balance_best.yaml",
                     "belongs to a library")
        self.refused(self.footfall("set", "top.yaml", "t=160ms", "--into-base", "--to", "x.yaml"), 2, "--to")

    def test_a_file_on_top_takes_them_instead(self):
        path = self.write("b.yaml", self.BASE)
        self.assertEqual(self.footfall("set", "b.yaml", "t=160ms", "--to", "mine.yaml", "--yes").returncode, 0)
        self.assertEqual((self.folder / "mine.yaml").read_text(),
                         "behavior: 1\nbase: b.yaml\nparameters:\n  t: {value: 160 ms}\n")
        self.assertEqual(pathlib.Path(path).read_text(), self.BASE)

    def test_bad_input(self):
        path = self.write("b.yaml", self.BASE)
        for setting, words in (("tt=1", "tt: there is no such"), ("t=1 s", "outside its range"),
                               ("t=1 N", "expected a time"), ("goal=[1]", "expected 2 values"), ("goal=1", "goal.x=1"),
                               ("t", "NAME=VALUE"), ("t=", "t"), ("t=[", "t")):
            with self.subTest(setting):
                self.refused(self.footfall("set", "b.yaml", setting, "--yes"), 2, words)
        self.refused(self.footfall("set", "none.yaml", "t=1", "--yes"), 2, "none.yaml")
        self.assertEqual(pathlib.Path(path).read_text(), self.BASE)


if __name__ == "__main__":
    main()
