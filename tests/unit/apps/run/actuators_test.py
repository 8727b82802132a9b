"""`footfall run` on series-elastic actuators and on the stub, from outside: actuators_test.py BINARY [CLASS...]."""
import json
import pathlib

from command import Case, main


class Actuators(Case):
    def transitions(self, backend, folder):
        self.footfall("run", "balance", "--backend", backend, "--for", "3s", "--log", folder, "--no-report", "--quiet")
        lines = self.footfall("events", folder, "--kind", "transition").stdout.splitlines()
        return [(float(line.split()[0]), " ".join(line.split()[3:])) for line in lines]

    # The stand has no physics: what time alone decides is the same, and what contacts decide comes in the same order.
    def test_the_statechart_takes_the_same_way_on_the_simulator_and_on_the_stub(self):
        simulated = self.transitions("mujoco", str(self.folder / "simulated"))
        stand = self.transitions("stub", str(self.folder / "stand"))
        self.assertGreater(len(simulated), 40)
        touchdown = [name for _, name in simulated].index("step.right_foot.land -> step.right_foot.load")
        self.assertEqual(simulated[:touchdown], stand[:touchdown])
        both = min(len(simulated), len(stand))
        self.assertEqual([name for _, name in simulated[:both]], [name for _, name in stand[:both]])

    def test_a_run_on_the_stub_writes_the_same_bytes_twice(self):
        logs = []
        for k in (1, 2):
            folder = str(self.folder / f"run{k}")
            self.footfall("run", "balance_best", "--backend", "stub", "--for", "1s", "--log", folder, "--no-report", "--quiet")
            logs.append(pathlib.Path(folder, "log.mcap").read_bytes())
        self.assertEqual(logs[0], logs[1])

    def test_the_stub_has_the_robots_actuators_unless_a_world_says_otherwise(self):
        told = self.footfall("run", "balance", "--backend", "stub", "--for", "50ms", "--no-log").stdout
        self.assertIn("series-elastic actuators", told)
        told = self.footfall("run", "balance", "--backend", "stub", "--world", "flat", "--for", "50ms", "--no-log").stdout
        self.assertIn("ideal actuators", told)

    def test_a_setting_of_the_world_is_used_and_told(self):
        def run(*settings):
            arguments = [word for text in settings for word in ("--set", text)]
            result = self.footfall("run", "balance_best", "--world", "sea", "--for", "200ms", "--no-log", "--quiet", "--json",
                                   *arguments)
            return json.loads(result.stdout)
        drawn, fixed = run(), run("world.actuators.coulomb=3Nm")
        self.assertIn("actuators.coulomb", drawn["variation"])
        self.assertEqual(fixed["world"], "sea actuators.coulomb=3Nm")
        self.assertNotEqual(drawn["peak_torque_Nm"], fixed["peak_torque_Nm"])

    def test_settings_of_the_world_are_checked_at_their_name(self):
        for setting, words in (("world.actuators.colomb=1Nm", ("world.actuators.colomb:1:1", "did you mean 'coulomb'")),
                               ("world.actuators.coulomb=1 m", ("world.actuators.coulomb:1:1", "expected a torque")),
                               ("world.actuators", ("NAME=VALUE",)),
                               ("world.actuators.spring={knie: 1 %}", ("no joint 'knie'",))):
            self.refused(self.run_it("balance_best", "--world", "sea", "--set", setting), 2, *words)

    def test_the_report_has_a_section_on_actuators_that_are_elastic_only(self):
        for world, expected in (("sea", True), ("flat", False)):
            folder = str(self.folder / world)
            self.footfall("run", "balance_best", "--world", world, "--for", "1s", "--log", folder, "--quiet")
            page = pathlib.Path(folder, "report.html").read_text()
            self.assertEqual("passivity (margin)" in page, expected)

    def test_a_log_of_elastic_actuators_replays_bit_for_bit(self):
        for options in (("--world", "sea"), ("--backend", "stub")):
            folder = str(self.folder / ("replayed" + options[1]))
            self.footfall("run", "balance_best", *options, "--for", "1s", "--log", folder, "--no-report", "--quiet")
            result = self.footfall("replay", "--verify", folder)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)


if __name__ == "__main__":
    main()
