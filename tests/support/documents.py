"""Console blocks of the documents: which there are, and whether a command printed what they say."""
import re


def blocks(text):
    """(language, first line number, lines) of each fenced block."""
    language, first, lines = None, 0, []
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("```"):
            if language is None:
                language, first, lines = line[3:].strip() or "text", number, []
            else:
                yield language, first, lines
                language = None
        elif language is not None:
            lines.append(line)


def matches(expected, actual):
    """Whether the lines are those expected, `...` being anything."""
    pattern = ""
    for line in expected:
        if line.strip() == "...":
            pattern += r"(?:.*\n)*?"
        else:
            pattern += ".*".join(re.escape(part) for part in line.rstrip().split("...")) + r"\s*\n"
    return re.fullmatch(pattern, "".join(line.rstrip() + "\n" for line in actual)) is not None
