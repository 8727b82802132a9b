"""`footfall identify` from outside: identify_test.py BINARY [CLASS...]."""
import json

import command

# Hume's robot file, right abduction to left knee.
SPRINGS = (440, 360, 415, 440, 450, 455)
ROTORS = (0.13572, 0.0872756, 0.0872756) * 2


class Identify(command.Case):
    def excite(self, *arguments):
        return json.loads(self.run_it("excite", "--world", "sea_hoist", "--json", "--quiet", *arguments)
                          .stdout.splitlines()[-1])

    def test_finds_what_the_seed_drew(self):
        drawn = self.excite("--seed", "5", "--set", "time=6s")["variation"]
        done = self.footfall("identify", self.log, "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        found = json.loads(done.stdout)
        self.assertTrue(found["good"])
        self.assertEqual(len(found["joints"]), 6)
        for j, joint in enumerate(found["joints"]):
            spring, delay = joint["spring_Nm_per_rad"], joint["delay_s"]["value"]
            self.assertAlmostEqual(spring["value"] / (SPRINGS[j] * drawn["actuators.spring"][j]), 1, delta=0.02)
            self.assertAlmostEqual(spring["difference"], spring["value"] / SPRINGS[j] - 1, delta=1e-9)
            self.assertAlmostEqual(joint["rotor_kgm2"]["value"] / ROTORS[j], 1, delta=0.02)
            self.assertAlmostEqual(joint["viscous_Nms_per_rad"]["value"] / 0.5, 1, delta=0.05)
            self.assertAlmostEqual(joint["coulomb_Nm"]["value"] / drawn["actuators.coulomb"][j], 1, delta=0.05)
            self.assertAlmostEqual(delay * 1500, 1, delta=0.05)

    def test_text_names_the_robot_files_values(self):
        self.excite("--set", "time=5s", "--backend", "stub")
        done = self.footfall("identify", self.log, "--joint", "*knee")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual([line for line in done.stdout.splitlines() if not line.startswith(" ")],
                         ["right_knee: rich enough", "left_knee: rich enough"])
        self.assertRegex(done.stdout, r"spring +4\d\d\.\d+ ± 0\.\d+ Nm/rad  \(robot file 415: [+-]\d\.\d\d %\)")
        self.assertRegex(done.stdout, r"delay .* ms  \(\d\.\d{3} ticks; the loop's law explains \d\d\.\d %\)")
        done = self.footfall("identify", self.log, "--joint", "knee")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--joint: error: no joint 'knee' with a spring", done.stderr)

    def test_numbers_only_of_what_moved(self):
        self.excite("--set", "size=0", "--for", "3s")
        done = self.footfall("identify", self.log)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stdout.count("NOT IDENTIFIED"), 6)
        self.assertNotIn("±", done.stdout)

    def test_ideal_actuators_are_refused(self):
        self.run_it("balance", "--for", "0.2s", "--quiet")
        done = self.footfall("identify", self.log)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("were ideal: expected a run with series-elastic ones", done.stderr)
        self.assertEqual(self.footfall("identify", "no.mcap").returncode, 2)


if __name__ == "__main__":
    command.main()
