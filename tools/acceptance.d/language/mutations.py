"""One-token mistakes in a YAML file of the behavior language, drawn at random; see mistakes.py."""
import re
from collections import namedtuple

import yaml

Token = namedtuple("Token", "start end text kind line")  # kind: word, number, punctuation
Mutation = namedtuple("Mutation", "text kind line what token new")  # text: the complete mutated file

DIMENSIONS = {"ms": "time", "s": "time", "mm": "length", "cm": "length", "m": "length", "N": "force", "Nm": "torque",
              "deg": "plain", "rad": "plain", "%": "plain", "Hz": "rate", "kg": "mass", "m/s": "velocity",
              "m/s^2": "acceleration", "1/s^2": "rate squared", "rad/s^2": "rate squared"}
ATOM = r"(?:ms|us|s|mm|cm|m|Nm|N|deg|rad|kg|Hz|%)(?:\^-?\d)?"
UNIT = rf"(?:1/)?{ATOM}(?:[/ ]{ATOM})*(?![\w.])"
NUMBER = re.compile(rf"(?:(?<=[\[,: ])-)?(?<![\w.])\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?![\w.])(?: ?(?P<unit>{UNIT}))?")
WORD = re.compile(r"[.\w/]+\.yaml|\$?[A-Za-z_]\w*(?:\.\$?\w+)*")
PUNCTUATION = re.compile(r"<=|>=|==|!=|[][{},:()+*/^<>=!?\"'&|%@`~;-]")
FREE = re.compile(r"\b(?:doc|log|reason): (\"[^\"]*\"|[^,}\n]*)")
QUOTED = re.compile(r"\"[^\"]*\"")
LETTERS = "abcdefghijklmnopqrstuvwxyz"
KINDS = ["misspell", "drop", "double", "swap", "unit", "name", "indent", "line"]


def comment_start(line):
    """Where the line's comment begins, its length if it has none."""
    quote = None
    for i, c in enumerate(line):
        if quote:
            quote = None if c == quote else quote
        elif c in "\"'":
            quote = c
        elif c == "#" and (i == 0 or line[i - 1].isspace()):
            return i
    return len(line)


def tokens_of_line(line):
    """(start, end, kind) of words, numbers with their unit and punctuation, outside comments and free text."""
    end = comment_start(line)
    free = [m.span(1) for m in FREE.finditer(line, 0, end)]
    if line.startswith("events:"):
        free += [m.span() for m in QUOTED.finditer(line, 0, end)]
    at, out = 0, []
    while at < end:
        inside = [b for a, b in free if a <= at < b]
        if inside:
            at = inside[0]
            continue
        for kind, pattern in (("number", NUMBER), ("word", WORD), ("punctuation", PUNCTUATION)):
            found = pattern.match(line, at, end)
            if found:
                out.append((at, found.end(), kind))
                at = found.end() - 1
                break
        at += 1
    return out


def tokens(text):
    out, offset = [], 0
    for number, line in enumerate(text.split("\n")):
        out += [Token(offset + a, offset + b, line[a:b], kind, number) for a, b, kind in tokens_of_line(line)]
        offset += len(line) + 1
    return out


def misspelt(word, rng):
    """The word with one letter dropped, doubled, swapped with the next or replaced."""
    first = 1 if word.startswith("$") and len(word) > 1 else 0
    i = rng.randrange(first, len(word))
    how = rng.choice(["drop", "double", "swap", "replace"])
    if how == "drop":
        return word[:i] + word[i + 1:]
    if how == "double":
        return word[:i] + word[i] + word[i:]
    if how == "swap" and len(word) > first + 1:
        i = rng.randrange(first, len(word) - 1)
        return word[:i] + word[i + 1] + word[i] + word[i + 2:]
    return word[:i] + rng.choice(LETTERS) + word[i + 1:]


def unit_of(token):
    return NUMBER.fullmatch(" " + token.text, 1).group("unit")  # the pattern needs a character before a sign


def parse(text):
    """The tree with positions; None if malformed."""
    try:
        return yaml.compose(text, Loader=yaml.BaseLoader)
    except yaml.YAMLError:
        return None


class Mutator:
    """Draws mutations of one file; meaning.py judges their meaning."""

    def __init__(self, text):
        self.text = text
        self.tree = parse(text)
        self.tokens = tokens(text)
        self.words = [t for t in self.tokens if t.kind == "word"]
        self.quantities = [t for t in self.tokens if t.kind == "number" and unit_of(t)]
        self.names = sorted({t.text for t in self.words})
        self.lines = text.split("\n")
        self.code_lines = sorted({t.line for t in self.tokens})
        # Lines of one key and its value: dropping more is not a mistake of one token.
        self.short_lines = [n for n in self.code_lines if sum(t.line == n for t in self.tokens) <= 3]
        missing = {"unit": not self.quantities, "line": not self.short_lines}
        self.kinds = [kind for kind in KINDS if not missing.get(kind)]

    def draw(self, rng):
        return getattr(self, "_" + rng.choice(self.kinds))(rng)

    def _put(self, kind, token, new, what):
        text = self.text[:token.start] + new + self.text[token.end:]
        return Mutation(text, kind, token.line, f"'{token.text}' {what}", token, new)

    def _misspell(self, rng):
        token = rng.choice(self.words)
        new = misspelt(token.text, rng)
        return self._put("misspell", token, new, f"-> '{new}'")

    def _drop(self, rng):
        return self._put("drop", rng.choice(self.tokens), "", "dropped")

    def _double(self, rng):
        token = rng.choice(self.tokens)
        blank = "" if token.kind == "punctuation" else " "
        return self._put("double", token, token.text + blank + token.text, "doubled")

    def _swap(self, rng):
        i = rng.randrange(len(self.tokens) - 1)
        a, b = self.tokens[i], self.tokens[i + 1]
        text = self.text[:a.start] + b.text + self.text[a.end:b.start] + a.text + self.text[b.end:]
        return Mutation(text, "swap", a.line, f"'{a.text}' and '{b.text}' swapped", None, None)

    def _unit(self, rng):
        token = rng.choice(self.quantities)
        unit = unit_of(token)
        new = token.text[:-len(unit)] + rng.choice([u for u in DIMENSIONS if u != unit])
        return self._put("unit", token, new, f"-> '{new}'")

    def _name(self, rng):
        token = rng.choice(self.words)
        new = rng.choice([n for n in self.names if n != token.text])
        return self._put("name", token, new, f"-> '{new}'")

    def _indent(self, rng):
        number = rng.choice(self.code_lines)
        line = self.lines[number]
        more = not line.startswith("  ") or rng.random() < 0.5
        new = "  " + line if more else line[2:]
        return self._lines("indent", number, [new], "indented " + ("more" if more else "less"))

    def _line(self, rng):
        return self._lines("line", rng.choice(self.short_lines), [], "dropped")

    def _lines(self, kind, number, new, what):
        text = "\n".join(self.lines[:number] + new + self.lines[number + 1:])
        return Mutation(text, kind, number, "line " + what, None, None)
