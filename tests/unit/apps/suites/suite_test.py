"""`footfall test` with children that pass, fail, crash, hang and talk nonsense: suite_test.py BINARY [CLASS...]."""
import json
import os
import pathlib
import re
import signal
import subprocess
import time
import xml.etree.ElementTree as ElementTree

import command

FAKE = str(pathlib.Path(__file__).with_name("fake_footfall.sh").resolve())

CHART = """behavior: 1
events: {go: "leaves"}
machine:
  states:
    a: {transitions: [{on: go, to: b}, {when: "time > 1 s", to: b}]}
    b: {type: final}
"""


STAND = """behavior: 1
robot: hume
machine:
  states:
    a: {contacts: [right_foot, left_foot], tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 5}}}}
"""


def children_of(pid):
    found = []
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            if stat.read_text().rpartition(")")[2].split()[1] == str(pid):
                found.append(stat.parent.name)
        except OSError:  # gone meanwhile
            pass
    return found


class Case(command.Case):
    def setUp(self):
        super().setUp()
        (self.folder / "tests/runs/regression").mkdir(parents=True)
        (self.folder / "tests/runs/regression/chart.yaml").write_text(CHART)

    def scenario(self, name, doc, seeds="[1]", labels="[]", expect=("time >= 0 s",), more=""):
        lines = "".join(f"  - {e}\n" for e in expect)
        path = self.folder / f"tests/runs/regression/{name}.yaml"
        path.write_text(f'scenario: 1\ndoc: "{doc}"\nbehavior: chart.yaml\nseeds: {seeds}\nlabels: {labels}\n'
                        f"for: 1 s\nexpect:\n{lines}{more}")
        return str(path.relative_to(self.folder))

    def options(self, *arguments):
        return ["test", "--program", FAKE, "-j", "2", *arguments]

    def footfall(self, *arguments):
        result = command.footfall(*self.options(*arguments), cwd=self.folder)
        path = self.folder / "out/test/session.json"
        self.session = json.loads(path.read_text()) if path.exists() else None
        return result

    def verdicts(self):
        return {s["name"]: [r["verdict"] for r in s["runs"]] for s in self.session["scenarios"]}


class Files(Case):
    def test_a_behavior_is_told_to_be_no_scenario(self):
        (self.folder / "mine.yaml").write_text("base: balance_best\nparameters: {clearance: {value: 5 cm}}\n")
        result = self.footfall("mine.yaml")
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("mine.yaml:1:1: error: this is a behavior, no scenario", result.stdout)

    def test_seeds_that_draw_nothing_are_warned_of(self):
        path = self.scenario("one", "pass", "1..3", more="world: ideal\n")
        result = self.footfall()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(path + ":4:8: warning: 3 seeds are one run 3 times", result.stderr)
        self.assertEqual(self.footfall("--seeds", "2").stderr, "")
        random = self.folder / "tests/runs/regression/random.lua"
        random.write_text("function roll() return math.random() end\n")
        self.scenario("one", "pass", "1..3", more="world: ideal\nscripts: random.lua\n")
        self.assertEqual(self.footfall().stderr, "")


class Children(Case):
    def test_all_good_is_exit_0_and_leaves_no_logs(self):
        self.scenario("one", "pass", "1..3")
        result = self.footfall()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("1 of 1 scenarios passed, 3 of 3 runs", result.stdout)
        self.assertEqual(sorted(os.listdir(self.folder / "out/test")), ["session.json"])

    def test_each_kind_of_failure_is_that_runs_and_no_one_elses(self):
        self.scenario("many", "crash@2 fail@3 garbage@4 silence@5 input@6 machine@7 fall@8 hang@9", "1..10")
        self.scenario("other", "pass")
        result = self.footfall("--timeout", "0.8s")
        self.assertEqual(self.verdicts(), {
            "many": ["passed", "crashed", "failed", "bad output", "bad output", "bad input", "machine failed", "failed",
                     "timed out", "passed"],
            "other": ["passed"]})
        self.assertEqual(result.returncode, 3)
        self.assertIn("SIGSEGV", result.stdout)
        self.assertIn("about to crash", result.stdout)
        self.assertIn("the robot fell: torso 0.5 m, at 1.000 s in a", result.stdout)

    def test_a_failure_says_what_was_expected_what_happened_when_where_and_how_to_rerun(self):
        path = self.scenario("tilts", "fail@102", "100..103")
        result = self.footfall()
        self.assertEqual(result.returncode, 1)
        for words in ("expected  time >= 0 s", f"{path}:8:5", "seed 102: it was too much (0.25 rad)", "at 1.500 s",
                      "tick 1500", "in a", "held in 3 of 4, not in 102", f"footfall run {path} --seed 102"):
            self.assertIn(words, result.stdout)
        self.assertTrue((self.folder / "out/test/tilts/seed-102/log.mcap").exists())
        self.assertFalse((self.folder / "out/test/tilts/seed-100").exists())

    def test_a_share_of_seeds_is_enough_where_it_is_said_but_no_crash_is_excused(self):
        share = "{that: time >= 0 s, in: 75 % of seeds}"
        self.scenario("enough", "fail@2", "1..4", expect=[share])
        self.scenario("too_few", "fail@2,3", "1..4", expect=[share])
        self.scenario("crashes", "crash@2", "1..4", expect=[share])
        self.scenario("falls", "fall_too@2", "1..4", expect=[share])
        self.footfall()
        passed = {s["name"]: s["passed"] for s in self.session["scenarios"]}
        self.assertEqual(passed, {"crashes": False, "enough": True, "falls": False, "too_few": False})

    def test_a_run_that_passes_does_not_take_the_folder_away_from_one_that_begins(self):
        self.scenario("begins", "late@2", "1..2")
        self.assertEqual(self.footfall().returncode, 0)
        self.assertEqual(self.verdicts(), {"begins": ["passed", "passed"]})

    def test_the_order_of_the_output_does_not_depend_on_who_ends_first(self):
        self.scenario("a", "slow")
        self.scenario("b", "pass", "1..3")
        lines = [line.split()[1] for line in self.footfall().stdout.splitlines() if line.startswith("PASS")]
        self.assertEqual(lines, ["a", "b"])

    def test_children_do_not_outlive_a_parent_that_was_killed(self):
        (self.folder / "tests/runs/regression/chart.yaml").write_text(STAND)
        path = self.folder / self.scenario("long", "runs for hours")
        path.write_text(path.read_text().replace("for: 1 s", "for: 50000 s"))
        environment = dict(os.environ, FOOTFALL_PATH=str(command.SOURCE))
        process = subprocess.Popen([command.BINARY, "test", "-j", "1"], cwd=self.folder, stdout=subprocess.DEVNULL, env=environment)
        child = None
        for _ in range(200):
            found = children_of(process.pid)
            if found and (self.folder / "out/test/long/seed-1/log.mcap").exists():
                child = found[0]
                break
            time.sleep(0.02)
        self.assertIsNotNone(child)
        process.kill()
        process.wait()
        for _ in range(100):
            if not pathlib.Path(f"/proc/{child}").exists():
                return
            time.sleep(0.02)
        self.fail(f"{child} is still there")

    def test_an_interrupt_ends_the_children_and_tells_what_was_done(self):
        self.scenario("a", "pass")
        self.scenario("b", "hang", "1..2")
        process = subprocess.Popen([command.BINARY, *self.options()], cwd=self.folder, stdout=subprocess.PIPE, text=True)
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=20)
        self.assertEqual(process.returncode, 1)
        self.assertIn("1 of 3 runs done", out)
        self.assertIn("interrupted", out)
        self.assertIn("STOP  b", out)


class Selection(Case):
    def setUp(self):
        super().setUp()
        self.scenario("push_left", "pass", "1..2", "[quick]")
        self.scenario("push_right", "pass", "1..2")
        self.scenario("stand", "fail@2", "1..2", "[quick]")

    def names(self, *arguments):
        self.footfall(*arguments)
        return [s["name"] for s in self.session["scenarios"]]

    def test_by_name_label_and_file(self):
        self.assertEqual(self.names("--filter", "push*"), ["push_left", "push_right"])
        self.assertEqual(self.names("--quick"), ["push_left", "stand"])
        self.assertEqual(self.names("tests/runs/regression/stand.yaml"), ["stand"])

    def test_seeds_of_the_command_line_take_the_place_of_the_files(self):
        self.names("--seeds", "7..8", "--filter", "stand")
        self.assertEqual([r["seed"] for r in self.session["scenarios"][0]["runs"]], [7, 8])
        self.names("--seeds", "9,2..3", "--filter", "stand")  # as `sweep` takes them
        self.assertEqual([r["seed"] for r in self.session["scenarios"][0]["runs"]], [9, 2, 3])

    def test_shards_are_the_whole_without_overlap(self):
        parts = [self.names("--shard", f"{i}/3") for i in (1, 2, 3)]
        self.assertEqual(sorted(sum(parts, [])), ["push_left", "push_right", "stand"])
        self.assertEqual([len(p) for p in parts], [1, 1, 1])

    def test_what_failed_is_run_again(self):
        self.assertEqual(len(self.names()), 3)
        self.assertEqual(self.names("--rerun-failed"), ["stand"])
        self.scenario("stand", "pass")
        self.assertEqual(self.footfall("--rerun-failed").returncode, 0)
        self.assertIn("nothing failed", self.footfall("--rerun-failed").stdout)

    def test_bad_arguments_are_exit_2_with_one_line(self):
        for arguments in (["--shard", "4/3"], ["--shard", "x"], ["--seeds", "5..1"], ["--seeds", "1,,2"], ["--seeds", "3,1..4"], ["--timeout", "5 kg"],
                          ["--filter", "none"], ["no/such.yaml"], ["--rerun-failed", "--out", "elsewhere"]):
            with self.subTest(arguments):
                result = self.footfall(*arguments)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertEqual(result.stderr.count("error:"), 1)

    def test_a_folder_without_scenarios_is_exit_2(self):
        (self.folder / "empty").mkdir()
        self.assertEqual(self.footfall("empty").returncode, 2)

    def test_a_scenario_with_a_mistake_fails_and_the_others_run(self):
        (self.folder / "tests/runs/regression/wrong.yaml").write_text("scenario: 1\nbehaviour: chart.yaml\n")
        result = self.footfall()
        self.assertEqual(result.returncode, 2)
        self.assertIn("wrong.yaml:2:1: error:", result.stdout)
        self.assertEqual(len(self.session["scenarios"]), 4)


class Bless(Case):
    def setUp(self):
        super().setUp()
        (self.folder / "tests/runs/regression/stand.yaml").write_text(STAND)
        self.golden = self.folder / "tests/runs/regression/traced.golden.csv"
        self.trace("pass")

    def trace(self, doc):
        path = self.folder / self.scenario("traced", doc, "1..3", more="golden: {tolerance: {com.pos.z: 1 mm}}\n")
        path.write_text(path.read_text().replace("chart.yaml", "stand.yaml"))

    def test_a_trace_becomes_golden_only_if_that_is_said(self):
        refused = self.footfall("--bless")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("a new trace: 1 signals, 2 rows", refused.stdout)
        self.assertFalse(self.golden.exists())
        self.assertEqual(self.footfall("--bless", "--yes").returncode, 0)
        self.assertEqual(self.golden.read_text(), "time,state,com.pos.z\n0.0,a,0.0\n0.5,a,0.5\n")
        self.assertIn("no golden trace changes", self.footfall("--bless").stdout)

    def test_what_is_blessed_is_not_told_as_a_failure(self):
        self.trace("drift")
        result = self.footfall("--bless", "--yes")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, r"(?m)^BLESS traced +tests/runs/regression/traced.golden.csv$")
        self.assertNotIn("FAIL", result.stdout)
        self.trace("fall")
        result = self.footfall("--bless", "--yes")
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stdout, r"(?m)^FAIL  traced ")
        self.assertIn("not blessed: the robot fell", result.stdout)

    def test_the_largest_difference_is_shown_and_when(self):
        self.footfall("--bless", "--yes")
        self.trace("slow")
        changed = self.footfall("--bless")
        self.assertIn("differs by up to 0.2, at 0.500 s", changed.stdout)
        self.assertIn("0.5,a,0.5", self.golden.read_text())

    def test_a_run_that_failed_is_not_blessed(self):
        self.trace("fail")
        result = self.footfall("--bless", "--yes")
        self.assertEqual(result.returncode, 1)
        self.assertIn("not blessed: an expectation did not hold", result.stdout)
        self.assertFalse(self.golden.exists())

    def test_without_any_golden_trace_it_is_bad_input(self):
        self.scenario("traced", "pass")
        self.assertEqual(self.footfall("--bless").returncode, 2)


class Formats(Case):
    def setUp(self):
        super().setUp()
        self.scenario("good", "pass", "1..2")
        self.scenario("bad", "crash@2 fail@1", "1..2", expect=("time >= 0 s", "time < 1 s and time > 0 s"))

    def test_junit_has_the_form_that_ci_systems_read(self):
        self.footfall("--junit", "junit.xml")
        root = ElementTree.parse(self.folder / "junit.xml").getroot()
        self.assertEqual(root.tag, "testsuites")
        for suite in root:
            self.assertEqual([e.tag for e in suite if e.tag != "testcase"], ["properties", "system-out", "system-err"])
            self.assertLessEqual({"id", "package", "name", "hostname", "timestamp", "tests", "failures", "errors", "time"},
                                 set(suite.attrib))
            self.assertRegex(suite.get("timestamp"), r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d$")
            cases = suite.findall("testcase")
            self.assertEqual(len(cases), int(suite.get("tests")))
            for kind in ("failure", "error"):
                found = [c for c in cases if c.find(kind) is not None]
                self.assertEqual(len(found), int(suite.get(kind + "s")))
            for case in cases:
                self.assertLessEqual({"name", "classname", "time"}, set(case.attrib))
                self.assertLessEqual(len(list(case)), 1)
        bad = root.find("testsuite[@name='bad']")
        self.assertEqual([c.get("name") for c in bad.findall("testcase")],
                         ["runs", "end", "time >= 0 s", "time < 1 s and time > 0 s"])
        self.assertIn("about to crash ?? <&>", bad.find("testcase/error").text)

    def cases(self, name):
        self.footfall("--junit", "junit.xml", "--filter", name)
        suite = ElementTree.parse(self.folder / "junit.xml").getroot().find("testsuite")
        return {case.get("name"): case for case in suite.findall("testcase")}

    def test_each_failure_is_in_junit_once_with_its_own_file_and_line(self):
        path = self.scenario("many", "twice", expect=("time >= 0 s", "time < 1 s"), more="script: [{at: 500 ms, raise: go}]\n")
        cases = self.cases("many")
        self.assertEqual({name: case.get("line") for name, case in cases.items() if case.find("failure") is not None},
                         {"script": "10", "time >= 0 s": "8", "time < 1 s": "9"})
        self.assertEqual({case.get("file") for case in cases.values()}, {path})
        for name, own in (("script", "the push never came"), ("time >= 0 s", "it was early"), ("time < 1 s", "it was late")):
            failure = cases[name].find("failure")
            self.assertTrue(failure.get("message").startswith("seed 1: " + own), failure.get("message"))
            self.assertIn(f"({path}:{cases[name].get('line')}:5)\n", failure.text)
            self.assertEqual(failure.text.count("happened"), 1)
        self.assertEqual([cases[name].find("failure").get("type") for name in ("script", "time < 1 s")],
                         ["script", "expectation"])

    def test_a_golden_mismatch_and_a_fall_are_failures_and_a_crash_is_an_error(self):
        (self.folder / "tests/runs/regression/chart.yaml").write_text(STAND)
        golden = "golden: {tolerance: {com.pos.z: 1 mm}}\n"
        for name, doc, case, kind in (("drifts", "drift", "golden", "failure"), ("falls", "fall", "end", "failure"),
                                      ("crashes", "crash", "runs", "error")):
            with self.subTest(name):
                self.scenario(name, doc, more=golden)
                cases = self.cases(name)
                told = {n: [e.tag for e in c] for n, c in cases.items() if c.find("skipped") is None}
                self.assertEqual({n: tags for n, tags in told.items() if tags}, {case: [kind]})
        self.assertEqual(cases["time >= 0 s"].find("skipped").get("message"), "no run came to its end")

    def test_each_failure_names_a_page_of_its_own_time(self):
        self.scenario("many", "twice", "1..2", expect=("time >= 0 s", "time < 1 s"))
        result = self.footfall("--filter", "many")
        pages = re.findall(r"report +(\S+)", result.stdout)
        folder = "out/test/many/seed-1"
        self.assertEqual(pages, [f"{folder}/{name}.html" for name in ("report", "report-0.600s", "report-5.500s")])
        self.assertEqual((self.folder / pages[2]).read_text(), "--from=4.000s --to=6.000s\n")

    def test_a_result_that_failed_without_a_failure_is_bad_output(self):
        self.scenario("silent", "unsaid")
        self.footfall("--filter", "silent")
        self.assertEqual(self.verdicts(), {"silent": ["bad output"]})

    def test_json_on_stdout_is_all_there_is_on_stdout(self):
        result = self.footfall("--json", "-")
        self.assertEqual(json.loads(result.stdout), self.session)
        self.assertFalse(self.session["passed"])
        self.assertEqual(self.session["counts"], {"scenarios": 2, "passed": 1, "failed": 1, "runs": 4})

    def test_coverage_names_what_no_run_reached(self):
        result = self.footfall("--coverage", "coverage.json")
        chart = "tests/runs/regression/chart.yaml"
        covered = json.loads((self.folder / "coverage.json").read_text())
        # Of the states machine, a, b two were entered; of two transitions one was taken; its condition was never true.
        self.assertEqual((covered["states"]["reached"], covered["states"]["of"]), (2, 3))
        self.assertEqual((covered["transitions"]["reached"], covered["transitions"]["of"]), (1, 2))
        self.assertEqual((covered["guard_outcomes"]["reached"], covered["guard_outcomes"]["of"]), (1, 2))
        self.assertIn(f"{chart}:6: state b was never entered", result.stdout)
        self.assertIn(f"{chart}:5: transition a -> b was never taken", result.stdout)
        self.assertIn(f"{chart}:5: guard the condition of a -> b was never true", result.stdout)
        self.assertTrue(re.search(r"states 67 %, transitions 50 %, guard outcomes 50 %", result.stdout))


if __name__ == "__main__":
    command.main()
