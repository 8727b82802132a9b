#!/usr/bin/env python3
"""Every place that a document or a comment names exists: files, headings, numbered paragraphs.

Documents: links and their #headings; paths in backticks that begin with a folder of the repository, with or without a
source file's suffix, with *, NAME or {h,cc}. Sources: the same paths in comments, and files beside them (`see door.h`).
Both: `docs/behaviors.md 8.3` is a paragraph that begins with this number.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
FOLDERS = "core hal model tasks behaviors engine lab sim apps tests tools docs robots examples cmake".split()
PATH = re.compile(r"(?<![\w./~$-])((?:%s)/(?:[\w.*/-]|\{[\w,]+\})*)" % "|".join(FOLDERS))
LINK = re.compile(r"\]\(([^)\s]+)\)")
CODE = re.compile(r"`([^`\n]+)`")
HEADING = re.compile(r"^#+ (.+)$", re.M)
PARAGRAPH = re.compile(r"docs/(\w+)\.md,? (?:paragraphs? )?(\d+\.\d+)")
SIBLING = re.compile(r"(?<![\w./*])(\w+\.(?:h|cc))\b")
COMMENT = re.compile(r"(?<!:)//[^\n]*|(?:^|(?<=\s))#[ !][^\n]*", re.M)
SUFFIXES = ("", ".h", ".cc", ".py", ".yaml", ".md")
ELSEWHERE = ("tests/language/mistakes", "tests/runs/docs/check_layers_test.py")  # their paths are not of this tree


# Files that the example changes of docs/adding_*.md make.
EXAMPLES = {name for patch in ROOT.glob("tests/changes/*.patch")
            for name in re.findall(r"^\+\+\+ b/(\S+)", patch.read_text(encoding="utf-8"), re.M)}


def slug(heading):
    """A heading's anchor, as GitHub makes it."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def alternatives(path):
    """a.{h,cc} -> a.h, a.cc."""
    found = re.search(r"\{([^{}]*)\}", path)
    if not found:
        return [path]
    return [p for part in found[1].split(",") for p in alternatives(path[:found.start()] + part + path[found.end():])]


def exists(path):
    """Whether the repository has the path, also without its suffix or as a pattern."""
    path = re.sub(r"[.]+$", "", path).rstrip("/").replace("NAME", "*")
    return all(one in EXAMPLES or any(any(ROOT.glob(one + suffix)) for suffix in SUFFIXES) for one in alternatives(path))


def paragraph_exists(document, number):
    """Whether docs/DOCUMENT.md has a paragraph that begins with this number."""
    path = ROOT / "docs" / f"{document}.md"
    return path.exists() and re.search(rf"^(?:[-*] )?\*{{0,2}}{re.escape(number)}\b", path.read_text(), re.M) is not None


def check_link(document, target):
    """What is wrong with a link in a document, or None."""
    if re.match(r"[a-z]+:", target):
        return None
    name, _, anchor = target.partition("#")
    path = (document.parent / name).resolve() if name else document
    if not path.exists():
        return f"link to '{target}': no such file"
    if anchor and anchor not in {slug(h) for h in HEADING.findall(path.read_text(encoding="utf-8"))}:
        return f"link to '{target}': no such heading"
    return None


def check_document(document):
    """Yields (line, message) of a Markdown file."""
    for number, line in enumerate(document.read_text(encoding="utf-8").splitlines(), 1):
        for target in LINK.findall(line):
            problem = check_link(document, target)
            if problem:
                yield number, problem
        for path in (p for code in CODE.findall(line) for p in PATH.findall(code)):
            if not exists(path):
                yield number, f"'{path}' does not exist"
        for name, paragraph in PARAGRAPH.findall(line):
            if not paragraph_exists(name, paragraph):
                yield number, f"docs/{name}.md has no paragraph {paragraph}"


def check_source(source):
    """Yields (line, message) of the comments in a source."""
    for number, line in enumerate(source.read_text(encoding="utf-8").splitlines(), 1):
        for comment in COMMENT.findall(line):
            siblings = SIBLING.findall(comment) if source.suffix in (".h", ".cc") else []
            for path in PATH.findall(comment) + [str(source.relative_to(ROOT).with_name(name)) for name in siblings]:
                if not exists(path):
                    yield number, f"'{path}' does not exist"
            for name, paragraph in PARAGRAPH.findall(comment):
                if not paragraph_exists(name, paragraph):
                    yield number, f"docs/{name}.md has no paragraph {paragraph}"


def main():
    paths = sorted(ROOT.glob("*.md")) + [p for folder in FOLDERS for p in sorted((ROOT / folder).rglob("*"))]
    failures, count = [], 0
    for path in paths:
        name = str(path.relative_to(ROOT))
        if not path.is_file() or name.startswith(ELSEWHERE) or "node_modules" in path.parts:
            continue
        if path.suffix == ".md":
            found = check_document(path)
        elif path.suffix in (".h", ".cc", ".cmake", ".yaml", ".py", ".sh") or path.name == "CMakeLists.txt":
            found = check_source(path)
        else:
            continue
        count += 1
        failures += [f"{name}:{line}: {message}" for line, message in found]
    print("\n".join(failures + [f"{count} files, {len(failures)} failures"]))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
