#!/usr/bin/env python3
"""tools/check_layers on a small tree: it passes, and one violation at a time is found at its file and line."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

TOOL = pathlib.Path(__file__).resolve().parents[3] / "tools/check_layers"
TABLE = """# Folders

| folder | what lives here | may include |
|---|---|---|
| `core/text` | text | |
| `core` | the rest | |
| `engine/tick` | the tick | |
| `sim` | a side branch | `core` |
| `apps` | commands | |
| `tests/unit/*` | tests | |

| folder | what lives here |
|---|---|
| `robots/` | another table: no sources |
"""
TREE = {
    "docs/folders.md": TABLE,
    "core/text/escape.h": "#pragma once\n",
    "core/fault.h": '#pragma once\n#include "core/text/escape.h"\ninline constexpr int kFaults = 3;\n',
    "engine/tick/loop.h": '#pragma once\n#include <vector>\n#include "core/fault.h"\n',
    "sim/scene.cc": '#include "core/fault.h"\n#include <mujoco/mujoco.h>\n',
    "apps/main.cc": '#include "engine/tick/loop.h"\n#include "sim/view.h"\n',
    "sim/view.h": "#pragma once\n",
    "tests/unit/core/fault_test.cc": '#include "apps/main.h"\n#include <dart/dart.hpp>\n',
    "apps/main.h": "#pragma once\n",
}


def body(lines):
    """Statements that make up a function's body, a line each; braces in strings and comments do not count."""
    return '  call("}", \'}\');  // }\n' * lines


class CheckLayers(unittest.TestCase):
    def problems(self, changes):
        """What the tool prints, as lines, for the tree with these files changed (None: removed)."""
        with tempfile.TemporaryDirectory() as folder:
            for name, text in {**TREE, **changes}.items():
                if text is not None:
                    path = pathlib.Path(folder, name)
                    path.parent.mkdir(parents=True, exist_ok=True)
                    path.write_text(text)
            done = subprocess.run([sys.executable, TOOL, folder], text=True, capture_output=True, check=False)
        lines = done.stderr.splitlines()
        self.assertEqual(done.returncode, 1 if lines else 0, done.stderr)
        return lines

    def expect(self, changes, place, words):
        """Exactly one problem, at `place`, that says `words`."""
        lines = self.problems(changes)
        self.assertEqual(len(lines), 1, lines)
        self.assertTrue(lines[0].startswith(place + ": error: "), lines[0])
        self.assertIn(words, lines[0])

    def test_a_tree_that_keeps_the_order_passes(self):
        self.assertEqual(self.problems({}), [])

    def test_an_include_of_a_folder_below(self):
        self.expect({"core/text/escape.h": '#pragma once\n#include "core/fault.h"\n'}, "core/text/escape.h:2",
                    "core/text/ may not include core/")

    def test_the_side_branch_sees_only_what_its_row_lists(self):
        self.expect({"sim/scene.cc": '#include "engine/tick/loop.h"\n'}, "sim/scene.cc:1", "sim/ may not include engine/tick/")

    def test_the_side_branch_is_not_seen_from_above(self):
        self.expect({"engine/tick/loop.h": '#pragma once\n#include "sim/view.h"\n'}, "engine/tick/loop.h:2",
                    "engine/tick/ may not include sim/")

    def test_a_folder_without_a_row(self):
        self.expect({"core/new/a.cc": "int a;\n"}, "core/new:1", "has no row")

    def test_a_row_without_a_folder(self):
        self.expect({"docs/folders.md": TABLE.replace("| `sim`", "| `hal` | hardware | |\n| `sim`")}, "docs/folders.md:8",
                    "'hal' has no sources")

    def test_an_include_that_is_not_from_the_root(self):
        self.expect({"apps/main.cc": '#include "main.h"\n'}, "apps/main.cc:1", "not written from the project's root")

    def test_a_dependency_beside_its_door(self):
        self.expect({"core/fault.h": "#pragma once\n#include <yaml-cpp/yaml.h>\n"}, "core/fault.h:2",
                    "yaml-cpp may be included only in core/yaml/, tests/")

    def test_a_folder_with_too_many_sources(self):
        self.expect({f"core/f{i}.cc": "\n" for i in range(22)}, "core:1", "23 sources, more than 22")

    def test_a_file_with_too_many_lines(self):
        self.expect({"core/long.cc": "int a;\n" * 401}, "core/long.cc:401", "401 lines")

    def test_a_function_with_too_many_lines(self):
        text = "namespace a {\nclass B {\n  int before() { return 0; }\n  int f(int x) const {\n" + body(59) + "  }\n};\n}\n"
        self.expect({"core/f.cc": text}, "core/f.cc:4", "a function of 61 lines, more than 60: int f(int x) const")

    def test_functions_of_sixty_lines_classes_and_tables_pass(self):
        table = "constexpr auto kRows = make<Row>({\n" + '  {"a(", 1},\n' * 70 + "});\n"
        functions = ("bool operator==(A a, A b) {\n" + body(58) + "}\n") * 2
        self.assertEqual(self.problems({"core/f.cc": table + functions}), [])

    def test_a_header_without_pragma_once(self):
        self.expect({"core/other.h": "int f();\n"}, "core/other.h:1", "#pragma once")

    def test_a_note_of_unfinished_work(self):
        self.expect({"core/f.cc": "int a;\n// TO" "DO later\n"}, "core/f.cc:2", "unfinished work")

    def test_a_constant_that_hides_one_of_a_header(self):
        self.expect({"core/f.cc": "constexpr int kFaults = 2;\n"}, "core/f.cc:1", "'kFaults' is a constant of core/fault.h")


if __name__ == "__main__":
    unittest.main()
