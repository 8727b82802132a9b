"""Layouts of LCM messages, worked out by hand, and descriptions that are refused. Argument: message_layouts.py."""
import importlib.util
import sys
import tempfile
import unittest
from pathlib import Path

spec = importlib.util.spec_from_file_location("message_layouts", sys.argv.pop(1))
message_layouts = importlib.util.module_from_spec(spec)
sys.dont_write_bytecode = True
spec.loader.exec_module(message_layouts)


def header(*structs):
    with tempfile.TemporaryDirectory() as folder:
        paths = []
        for k, text in enumerate(structs):
            paths.append(Path(folder) / f"{k}.lcm")
            paths[-1].write_text("package footfall_lcm;\n" + text)
        return message_layouts.header(message_layouts.read(paths))


class Layouts(unittest.TestCase):
    def layout(self, *structs):
        return header(*structs).split('return "')[1].split('"')[0]

    def test_every_type_has_its_size(self):
        self.assertEqual(self.layout("""struct a_t { int8_t a; boolean b; byte c; int16_t d; int32_t e; float f;
            int64_t g; double h; string i; const int32_t LARGEST_PACKET = 99; }"""), "11124488s")

    def test_arrays_of_fixed_and_of_counted_length(self):
        self.assertEqual(self.layout("""struct a_t { double p[3]; int32_t n;  // int32_t no;
            float x[n][2]; string s[n]; byte mac[32]; /* double no; */ const int32_t LARGEST_PACKET = 99; }"""),
            "888c{44}{s}m")

    def test_a_message_in_a_message_is_laid_out_in_place_with_bounded_texts(self):
        self.assertEqual(self.layout("struct b_t { string name; int32_t k; double v[k]; }",
                                     """struct a_t { int32_t n; b_t all[n]; const int32_t LARGEST_PACKET = 99;
                                     const int32_t LONGEST_TEXT = 5; }"""), "c{nc{8}}")

    def test_lists_that_share_a_count_become_equally_long(self):
        text = header("struct a_t { int32_t n; double x[n]; double y[n]; const int32_t LARGEST_PACKET = 9; }")
        self.assertIn("m.n = static_cast<std::int32_t>(m.x.size()); m.y.resize(m.x.size());", text)

    def test_messages_without_a_largest_packet_are_no_packets(self):
        text = header("struct b_t { double x; }", "struct a_t { b_t b; const int32_t LARGEST_PACKET = 9; }")
        self.assertIn("#define FOOTFALL_PACKETS(X) X(a_t)\n", text)


class Refusals(unittest.TestCase):
    def refused(self, text, struct):
        with self.assertRaises(SystemExit) as caught:
            header(struct)
        self.assertEqual(caught.exception.code, f"message_layouts.py: {text}")

    def test_a_list_of_an_earlier_count(self):
        self.refused("a_t.x: the count 'n' must be the latest one before it",
                     "struct a_t { int32_t n; int32_t m; double y[m]; double x[n]; const int32_t LARGEST_PACKET = 9; }")

    def test_a_count_that_is_no_int32(self):
        self.refused("a_t.n: a count is one int32_t",
                     "struct a_t { int8_t n; double x[n]; const int32_t LARGEST_PACKET = 9; }")

    def test_a_type_that_is_not_known(self):
        self.refused("a_t.x: unknown type 'b_t'", "struct a_t { b_t x; const int32_t LARGEST_PACKET = 9; }")

    def test_a_line_that_is_no_field(self):
        self.refused("a_t: cannot read 'double'", "struct a_t { double; }")


if __name__ == "__main__":
    unittest.main()
