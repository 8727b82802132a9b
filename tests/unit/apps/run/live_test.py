"""`footfall run --lcm` from outside: live_test.py BINARY. Where LCM has no network only the refusals are tried."""
import json
import os
import socket
import unittest

import command


def has_network():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("239.255.76.67", 7667))
        except OSError:
            return False
    return True


class Live(command.Case):
    def setUp(self):
        super().setUp()
        self.url = f"udpm://239.255.76.67:{command.free_port()}?ttl=0"

    def run_it(self, *arguments):
        return self.footfall("run", "balance", "--for", "0.1s", "--no-log", *arguments,
                             env=dict(os.environ, XDG_RUNTIME_DIR=str(self.folder)))

    def refused(self, text, *arguments):
        result = self.run_it(*arguments)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn(text, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)

    def test_what_cannot_be_is_refused_in_one_sentence(self):
        self.refused("'tcpq://here' is of no network that live tuning can use", "--lcm=tcpq://here")
        self.refused("names '10.0.0.1', no multicast address", "--lcm", "udpm://10.0.0.1:7667")
        self.refused("'A.*' cannot begin the names of channels", "--lcm", "--lcm-prefix", "A.*")
        self.refused("expected a rate from 0 to 10000 Hz", "--lcm", "--telemetry", "often")
        self.refused("no such file; `footfall tune key none`", "--lcm", "--lcm-key", "none")
        self.refused("requires --lcm", "--lcm-open")

    def test_a_key_that_others_may_read_is_refused(self):
        key = self.folder / "shared.key"
        key.write_text("ab" * 32)
        key.chmod(0o644)
        self.refused("others than its owner may read or write this key", "--lcm", "--lcm-key", str(key))

    @unittest.skipUnless(has_network(), "LCM has no network here")
    def test_it_says_where_it_listens_and_what_came(self):
        result = self.run_it("--lcm", self.url, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        live = json.loads(result.stdout.splitlines()[-1])["live"]
        self.assertEqual(live["url"], self.url)
        self.assertEqual((live["applied"], live["refused"]), (0, 0))
        self.assertIn(f"live at {self.url}: footfall tune", result.stderr)
        self.assertIn("0 edits applied, 0 refused; 0 packets rejected", result.stderr)
        self.assertEqual((self.folder / "footfall" / "lcm.key").stat().st_mode & 0o777, 0o600)

    @unittest.skipUnless(has_network(), "LCM has no network here")
    def test_without_a_key_it_warns(self):
        result = self.run_it(f"--lcm={self.url}", "--lcm-open", "--quiet")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("warning: --lcm-open: everybody who reaches " + self.url + " may change this run", result.stderr)
        self.assertFalse((self.folder / "footfall").exists())

    def test_without_lcm_nothing_listens(self):
        result = self.run_it("--json")
        self.assertNotIn("live", json.loads(result.stdout.splitlines()[-1]))
        self.assertFalse((self.folder / "footfall").exists())


if __name__ == "__main__":
    command.main()
