#!/usr/bin/env python3
"""Usage: tests/language/fuzz/make_corpus.py FOLDER

Writes what the fuzzers start from, taken from this tree: FOLDER/behavior, FOLDER/expression, FOLDER/robot (one file an
input) and FOLDER/words.dict (every key, word, function and unit of the language).
"""
import hashlib
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent.parent
PIECES = [": ", ", ", "{", "}", "[", "]", "- ", "\n  ", "$", '"= ', "+: ", "&a ", "*a", " ? ", " : ", "^2", " and ",
          " or ", " not ", ">=", "==", "in(", "1e308", "-1", "0", "16 ms", "100 N", "5 deg", "220 1/s^2", "70 %"]


def put(folder, texts):
    folder.mkdir(parents=True, exist_ok=True)
    for text in texts:
        (folder / hashlib.sha1(text.encode()).hexdigest()[:16]).write_text(text, encoding="utf-8")


def read(pattern):
    return [path.read_text(encoding="utf-8") for path in sorted(ROOT.glob(pattern))]


def strings(source):
    """The string literals of C++ text; raw ones whole."""
    raw = re.findall(r'R"\((.*?)\)"', source, flags=re.S)
    rest = re.sub(r'R"\(.*?\)"', "", source, flags=re.S)
    return raw, [re.sub(r'"\s*"', "", s).replace('\\"', '"').replace("\\n", "\n")
                 for s in re.findall(r'"((?:[^"\\\n]|\\.|"\s*\n\s*")*)"', rest)]


def behaviors():
    yield from read("behaviors/library/*.yaml") + read("examples/*.yaml")
    yield from (text for text in read("tests/**/*.yaml") if "behavior:" in text)
    for source in read("tests/**/*.cc"):
        raw, _ = strings(source)
        for text in raw:
            if "behavior: 1" in text:
                yield text
            elif re.match(r"\s+\S+:", text):  # a machine's own lines
                yield "behavior: 1\nmachine:\n" + text


def expressions():
    for source in read("tests/unit/behaviors/expression*.cc"):
        yield from (s for s in strings(source)[1] if re.search(r"[\w)]\s*[-+*/^<>?(]", s) and "\n" not in s)
    for text in read("behaviors/library/*.yaml") + read("examples/*.yaml"):
        yield from re.findall(r'"= ([^"]+)"', text)


def words():
    found = set(PIECES)
    for source in read("behaviors/language/language*.cc") + read("model/*keys.cc") + read("core/units/units.cc"):
        found.update(s for s in strings(source)[1] if 0 < len(s) <= 24 and " " not in s)
    return sorted(found)


def quoted(word):
    return "".join(c if " " <= c <= "~" and c not in '"\\' else "".join(f"\\x{b:02x}" for b in c.encode()) for c in word)


def make(folder):
    put(folder / "behavior", behaviors())
    put(folder / "expression", expressions())
    put(folder / "robot", read("robots/*/robot.yaml"))
    (folder / "words.dict").write_text("".join(f'"{quoted(word)}"\n' for word in words()), encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    make(Path(sys.argv[1]))
