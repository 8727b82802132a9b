#!/usr/bin/env python3
"""Usage: message_layouts.py FILE.lcm... > layouts.hpp

What the codec of live tuning (engine/live/codec.cc) must know of each message before lcm-gen's code may read a packet, as
a C++ header. A message with the constant LARGEST_PACKET (bytes) is sent on a channel of its own; LONGEST_TEXT (bytes)
bounds each text in it. For each such message:
- layout_of(): how the bytes behind the fingerprint follow each other:
    1 2 4 8  a number of so many bytes        s n  a text; one of at most LONGEST_TEXT bytes
    c {...}  a count; the bytes of one entry, as often as the latest count says
    m        `byte mac[32]`, the last field of a message that is signed
- settle(): sets each count to the length of its list, and makes lists that share a count equally long;
and FOOTFALL_PACKETS(X), X(type) for all of them. A message that this cannot describe is an error.
"""
import re
import sys
from pathlib import Path

SIZES = {"int8_t": 1, "boolean": 1, "byte": 1, "int16_t": 2, "int32_t": 4, "float": 4, "int64_t": 8, "double": 8}
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)
STRUCT = re.compile(r"\bstruct\s+(\w+)\s*\{(.*?)\}", re.S)
CONSTANT = re.compile(r"const\s+\w+\s+(\w+)\s*=\s*(\w+)$")
FIELD = re.compile(r"(\w+)\s+(\w+)((?:\s*\[\s*\w+\s*\])*)$")


def fail(text):
    sys.exit(f"message_layouts.py: {text}")


class Message:
    """One struct: `fields` as (type, name, dimensions), `constants` by name."""

    def __init__(self, name, body):
        self.name, self.fields, self.constants = name, [], {}
        for line in filter(None, (part.strip() for part in body.split(";"))):
            if constant := CONSTANT.match(line):
                self.constants[constant[1]] = int(constant[2], 0)
            elif field := FIELD.match(line):
                self.fields.append((field[1], field[2], re.findall(r"\w+", field[3])))
            else:
                fail(f"{name}: cannot read '{line}'")
        self.counts = {d for _, _, dimensions in self.fields for d in dimensions if not d.isdigit()}
        self.signed = bool(self.fields) and self.fields[-1] == ("byte", "mac", ["32"])


def layout(message, messages, bounded):
    """The layout of a message's bytes."""
    out, latest = "", None

    def entry(kind, name, dimensions):
        if dimensions:
            inner = entry(kind, name, dimensions[1:])
            if dimensions[0].isdigit():
                return inner * int(dimensions[0])
            if dimensions[0] != latest or not inner:
                fail(f"{message.name}.{name}: the count '{dimensions[0]}' must be the latest one before it")
            return "{" + inner + "}"
        if kind == "string":
            return "n" if bounded else "s"
        if kind in SIZES:
            return str(SIZES[kind])
        if kind not in messages:
            fail(f"{message.name}.{name}: unknown type '{kind}'")
        return layout(messages[kind], messages, bounded)

    for kind, name, dimensions in message.fields:
        if name in message.counts:
            if kind != "int32_t" or dimensions:
                fail(f"{message.name}.{name}: a count is one int32_t")
            out, latest = out + "c", name
        elif message.signed and name == "mac":
            out += "m"
        else:
            out += entry(kind, name, dimensions)
    return out


def settle(message, messages):
    """C++ statements that make counts and lists agree."""
    out, first = [], {}
    for kind, name, dimensions in message.fields:
        if dimensions and not dimensions[0].isdigit():
            count = dimensions[0]
            if count not in first:
                first[count] = name
                out.append(f"m.{count} = static_cast<std::int32_t>(m.{name}.size());")
            else:
                out.append(f"m.{name}.resize(m.{first[count]}.size());")
            if len(dimensions) == 2 and dimensions[1].isdigit():
                out.append(f"for (auto& entry : m.{name}) entry.resize({dimensions[1]});")
            elif len(dimensions) > 1:
                fail(f"{message.name}.{name}: more than a list of arrays of one length")
        if kind in messages and messages[kind].counts:
            if len(dimensions) != 1:
                fail(f"{message.name}.{name}: messages with counts are in lists only")
            out.append(f"for ({kind}& entry : m.{name}) settle(entry);")
    return " ".join(out)


def header(messages):
    packets = [m for m in messages.values() if "LARGEST_PACKET" in m.constants]
    lines = ["// Made by engine/lcm/message_layouts.py from the .lcm files.", "#pragma once", "", "#include <cstdint>",
             "#include <string_view>", ""]
    lines += [f"#include <footfall_lcm/{name}.hpp>" for name in messages]
    lines += ["", "#define FOOTFALL_PACKETS(X) " + " ".join(f"X({m.name})" for m in packets), "",
              "namespace footfall_lcm {"]
    for m in messages.values():
        if m.counts:
            lines.append(f"inline void settle({m.name}& m);")
    for m in messages.values():
        if m.counts or m in packets:
            lines.append(f"inline void settle([[maybe_unused]] {m.name}& m) {{ {settle(m, messages)} }}")
    for m in packets:
        text = layout(m, messages, "LONGEST_TEXT" in m.constants)
        longest = m.constants.get("LONGEST_TEXT", 0)
        lines += [f'constexpr std::string_view layout_of(const {m.name}&) {{ return "{text}"; }}',
                  f"constexpr std::int32_t longest_text(const {m.name}&) {{ return {longest}; }}"]
    return "\n".join(lines + ["}  // namespace footfall_lcm", ""])


def read(paths):
    messages = {}
    for path in paths:
        for name, body in STRUCT.findall(COMMENT.sub("", Path(path).read_text())):
            messages[name] = Message(name, body)
    return messages


if __name__ == "__main__":
    sys.stdout.write(header(read(sys.argv[1:])))
