"""Decides which one-token edits may be intended by the author; mistakes.py lists the rules.

Based only on the file's text and its YAML tree, never on Footfall's output.
"""
import re

import yaml
from mutations import DIMENSIONS, parse, unit_of

NAME = re.compile(r"[A-Za-z_]\w*$")
REFERENCES = {"to", "initial", "default", "safe"}  # keys that name states
# Keys whose value is one of a few keywords; those of one row are equally valid.
WORDS = {"axes": [{"x", "y", "z"}, {"roll", "pitch", "yaw"}],
         "trajectory": [{"cosine", "minimum_jerk", "hold"}],
         "on_late": [{"keep_last", "closed_form"}],
         "form": [{"frozen", "continuous"}],
         "live": [{"true", "false"}], "retarget": [{"true", "false"}], "internal": [{"true", "false"}]}
# Lists of independent items.
LISTS = {"transitions", "do", "on_entry", "on_exit", "invoke"}
# Keys that may be omitted unnoticed.
OPTIONAL = {"doc", "ranges", "on_entry", "on_exit", "internal", "retarget", "live", "form", "frame",
            "acceleration_limit", "width_offset", "goal_speed", "goal_error_limit", "reach"}


def plain(node):
    """The tree without positions: ('s', text), ('l', items), ('m', ((key, value), ...))."""
    if isinstance(node, yaml.ScalarNode):
        return ("s", node.value, node.style in ("'", '"'))
    if isinstance(node, yaml.SequenceNode):
        return ("l", tuple(plain(n) for n in node.value))
    if isinstance(node, yaml.MappingNode):
        return ("m", tuple((plain(k), plain(v)) for k, v in node.value))
    return ("s", "", False)


def removed(before, after, path=()):
    """Paths of complete entries missing in `after`; None if there are other differences."""
    if before == after:
        return []
    if before[0] != after[0] or before[0] == "s":
        return None
    if before[0] == "l":
        if len(before[1]) == len(after[1]) + 1:
            for i in range(len(before[1])):
                if before[1][:i] + before[1][i + 1:] == after[1]:
                    return [path + (i,)]
        if len(before[1]) != len(after[1]):
            return None
        pairs = list(zip(range(len(before[1])), before[1], after[1]))
    else:
        old, new = dict(before[1]), dict(after[1])
        if len(old) != len(before[1]) or len(new) != len(after[1]) or any(k not in old for k in new):
            return None
        pairs = [(k[1], old[k], new.get(k)) for k in old]
    out = []
    for key, a, b in pairs:
        below = [path + (key,)] if b is None else removed(a, b, path + (key,))
        if below is None:
            return None
        out += below
    return out


class Meaning:
    """Meaning of the words in one file."""

    def __init__(self, mutator):
        self.mutator = mutator
        self.places = []  # (start, end, path, is_key), scalars only
        self._walk(mutator.tree, ())
        self.plain = plain(mutator.tree)
        self.based = mutator.text.startswith("base:") or "\nbase:" in mutator.text
        keys = [path for _, _, path, is_key in self.places if is_key]
        self.states = {p[-1] for p in keys if len(p) > 1 and p[-2] == "states"}
        self.stacks = {p[-1] for p in keys if len(p) == 2 and p[0] == "stacks"}
        self.tables = {p[-1] for p in keys if len(p) == 2 and p[0] == "gains"} - {"ranges"}
        self.tasks = {p[-1] for p in keys if len(p) > 1 and p[-2] == "tasks"}
        self.dimensions = self._dimensions()

    def _walk(self, node, path):
        if isinstance(node, yaml.ScalarNode):
            self.places.append((node.start_mark.index, node.end_mark.index, path, False))
        elif isinstance(node, yaml.SequenceNode):
            for i, item in enumerate(node.value):
                self._walk(item, path + (i,))
        else:
            for key, value in node.value:
                self.places.append((key.start_mark.index, key.end_mark.index, path + (key.value,), True))
                self._walk(value, path + (key.value,))

    def _dimensions(self):
        """Dimension of every operand in the file's expressions."""
        out = {}
        for token in self.mutator.quantities:
            place = self.place(token)
            if place and place[0][0] == "parameters":
                out.setdefault("$" + place[0][1], DIMENSIONS.get(unit_of(token), unit_of(token)))
        for name in self.mutator.names:
            if re.match(r"entry(\.|$)|com\.pos|planner\.\w+\.target", name):
                out[name] = "length"
            elif name in ("t", "time") or name.endswith(".extension"):
                out[name] = "time"
        return out

    def place(self, token):
        """(path, is_key) of the scalar that contains the token."""
        for start, end, path, is_key in self.places:
            if start <= token.start and token.end <= end:
                return path, is_key
        return None

    def may_be_meant(self, mutation):
        after = parse(mutation.text)
        if after is not None:
            gone = removed(self.plain, plain(after))
            if gone is not None and all(self._may_go(path) for path in gone):
                return True  # also for an unchanged tree
        if mutation.kind == "unit":
            return self._same_quantity(mutation)
        if mutation.kind in ("misspell", "name"):
            return self._same_kind(mutation)
        return False

    def _may_go(self, path):
        key = path[-1]
        if isinstance(key, int):
            return len(path) > 1 and path[-2] in LISTS
        if key == "transitions":  # the state has another way out
            return any(p[:-1] == path[:-1] and p[-1] == "after" for _, _, p, is_key in self.places if is_key)
        over_stack = "tasks" in path and "states" in path  # a state's key that overrides its stack's
        state = len(path) > 1 and path[-2] == "states" and not self._refers(key)
        return self.based or key in OPTIONAL or (over_stack and "stacks" not in path) or state

    def _refers(self, state):
        """Whether the state is referenced."""
        keys = "|".join(REFERENCES)
        pattern = rf"\b(?:{keys}): (?:\[[^]]*)?{state}\b|\bin\({state}\b|done\.state\.{state}\b"
        return bool(re.search(pattern, self.mutator.text))

    def _same_quantity(self, mutation):
        old = unit_of(mutation.token)
        new = mutation.new[len(mutation.token.text) - len(old):]
        path, _ = self.place(mutation.token) or ((), False)
        kinds = {DIMENSIONS.get(old, old), DIMENSIONS.get(new, new)}
        return len(kinds) == 1 or (path[-1:] == ("at",) and kinds == {"plain", "time"})

    def _same_kind(self, mutation):
        old, new, place = mutation.token.text, mutation.new, self.place(mutation.token)
        if place is None:
            return False
        path, is_key = place
        if is_key:
            return self._same_kind_of_key(path, new)
        names = [p for p in path if not isinstance(p, int)]
        key = names[-1]
        kinds = [set(words) for words in WORDS.get(key, [])]
        if key in REFERENCES:
            kinds.append(self.states)
        if key in ("stack", "toward"):
            kinds.append(self.stacks)
        if key == "gains":
            kinds.append(self.tables)
        if key == "mark":
            return mutation.kind == "name" and bool(NAME.match(new))
        if any(old in kind and new in kind for kind in kinds):
            return True
        return old in self.dimensions and self.dimensions[old] == self.dimensions.get(new, "none")

    def _same_kind_of_key(self, path, new):
        if not NAME.match(new) or len(path) < 2:
            return False
        if path[-2] == "states":  # renamed without any reference
            return not self.based and not self._refers(path[-1]) and new not in self.states
        if path[-2] == "tasks" and "states" in path:
            return new in self.tasks
        return path[-2] == "internal" and new not in ("on", "off", "yes", "no", "true", "false")
