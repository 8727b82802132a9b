"""`--help`, `--version` and what is printed for the documents: help_test.py BINARY."""
from command import SOURCE, Case, main


class Help(Case):
    def test_version(self):
        result = self.footfall("--version")
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stdout, r"^\d+\.\d+\.\d+\n$")

    def test_the_reference_in_the_documents_is_what_the_program_prints(self):
        self.assertEqual(self.footfall("reference").stdout, (SOURCE / "docs/reference.md").read_text(),
                         "run `footfall reference > docs/reference.md`")

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

    def test_the_value_of_an_option_that_the_shell_has_split_is_told_to_be_quoted(self):
        for arguments in (["run", "squat.yaml", "--for", "2", "s"], ["run", "--for=2", "s", "squat.yaml"]):
            with self.subTest(arguments):
                result = self.footfall(*arguments)
                self.assertEqual(result.returncode, 2)
                self.assertIn('quote it: "--for=2 s"', result.stderr)
        self.assertNotIn("quote it", self.footfall("run", "a.yaml", "--seed", "2", "b.yaml").stderr)

    def test_signals_of_a_filter_parameters_and_gains(self):
        result = self.footfall("signals", "balance", "gains.single.*.kp")
        self.assertEqual(len(result.stdout.splitlines()), 3)
        self.assertRegex(result.stdout, r"gains\.single\.height\.kp +1/s\^2 +gain 270, range 5 to 800, live")
        result = self.footfall("signals", "balance", "lift_time")
        self.assertRegex(result.stdout, r"\$lift_time +s +parameter 0\.145, range 0\.11 to 0\.16, live")
        result = self.footfall("signals", "balance", "lift_tiem")
        self.assertEqual((result.returncode, result.stdout), (2, ""))

    def test_signals_have_names_and_units(self):
        result = self.footfall("signals", "balance")
        self.assertEqual(result.returncode, 0)
        names = [line.split()[0] for line in result.stdout.splitlines()]
        self.assertIn("com.pos.z", names)
        self.assertEqual(len(names), len(set(names)))


if __name__ == "__main__":
    main()
