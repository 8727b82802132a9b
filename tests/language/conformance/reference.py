#!/usr/bin/env python3
"""Random charts through Footfall and through an interpreter of its own: reference.py TRACE_MANY COUNT [SEED].

`Interpreter` is the pseudo-code of W3C SCXML 1.0 (2015), Appendix D, in Python, procedure by procedure under their own
names, with sets where the Recommendation has sets and without an eye on speed. What Footfall adds is marked `ours`:
`done: any | REGION`, a root with transitions, `after` without a send, the bound of micro steps. TRACE_MANY reads charts
and scripts, one JSON object a line, and prints their traces (the lines of `footfall trace`) in the same way.
A difference is printed with its chart; exit 1.
"""
import json
import random
import subprocess
import sys
from collections import deque

MICRO_STEPS = 12
QUEUE = 200  # a chart that raises more at once is left out: Footfall's queues are bounded


class State:
    def __init__(self, name, spec, parent, order):
        self.id, self.spec, self.parent = name, spec, parent
        self.ancestors = [] if parent is None else [parent] + parent.ancestors
        self.order = len(order)  # document order
        order.append(self)
        self.children = [State(n, s or {}, self, order) for n, s in spec.get("states", {}).items()]
        self.kind = spec.get("type") or ("compound" if self.children else "atomic")
        self.history = [c for c in self.children if c.kind == "history"]
        self.states = [c for c in self.children if c.kind != "history"]  # getChildStates
        self.transitions = []

    def path(self):
        return f"{self.parent.path()}.{self.id}" if self.parent and self.parent.parent else self.id


class Transition:
    def __init__(self, source, spec, state_of):
        self.source, self.spec = source, spec
        to = spec.get("to", [])
        self.target = [state_of[t] for t in ([to] if isinstance(to, str) else to)]
        on = spec.get("on")
        self.events = None if on is None else [on] if isinstance(on, str) else on
        self.internal = spec.get("internal", False)


def isDescendant(s, ancestor):
    return ancestor in s.ancestors


def getProperAncestors(s, stop):
    return s.ancestors[:s.ancestors.index(stop)] if stop in s.ancestors else s.ancestors


class Interpreter:
    def __init__(self, machine):
        self.states = []
        self.root = State("machine", machine, None, self.states)
        state_of = {s.id: s for s in self.states}  # the generator gives every state a name of its own
        for s in self.states:
            for t in s.spec.get("transitions", []):
                s.transitions.append(Transition(s, t, state_of))
            if "after" in s.spec:
                s.transitions.append(Transition(s, {"after": s.spec["after"], "to": s.spec["to"]}, state_of))
            first = s.spec.get("initial") or (s.states[0].id if s.kind == "compound" else [])
            s.initial = [state_of[n] for n in ([first] if isinstance(first, str) else first)]
        for s in self.states:
            if s.kind != "history":
                continue
            default = s.spec.get("default", [])
            default = [state_of[n] for n in ([default] if isinstance(default, str) else default)]
            s.default = default or (s.parent.initial if s.parent.kind == "compound" else s.parent.states)  # ours: docs/behaviors.md 8.6
        self.configuration, self.historyValue = set(), {}
        self.internalQueue, self.externalQueue = deque(), deque()
        self.variables = {"n": 0}
        self.running, self.now, self.steps = True, 0, 0
        self.entered_at, self.used = {}, set()
        self.enterStates(None)

    # ours: a tick, docs/behaviors.md 8.3; the order is mainEventLoop's
    def tick(self, event=None):
        self.steps = 0
        if event is not None:
            self.externalQueue.append(event)
        while self.running:
            queue = None
            enabled = self.selectTransitions(None)
            while not enabled:
                queue = self.internalQueue or self.externalQueue
                if not queue:
                    return
                enabled = self.selectTransitions(queue[0])
                if not enabled:
                    queue.popleft()
            if self.steps == MICRO_STEPS:
                self.internalQueue.append("error.execution")
                return
            if queue is not None:
                queue.popleft()
            self.steps += 1
            self.microstep(enabled)

    def sorted(self, states):
        return sorted(states, key=lambda s: s.order)

    def selectTransitions(self, event):
        enabledTransitions = []
        for state in self.sorted(s for s in self.configuration if s.kind in ("atomic", "final")):
            for s in [state] + getProperAncestors(state, None):
                t = next((t for t in s.transitions if self.matches(t, event)), None)
                if t is not None:
                    if t not in enabledTransitions:
                        enabledTransitions.append(t)
                    break
        return self.removeConflictingTransitions(enabledTransitions)

    def matches(self, t, event):
        if (t.events is None) != (event is None):
            return False
        if event is not None and not any(heard(pattern, event) for pattern in t.events):
            return False
        if "after" in t.spec:  # ours: docs/behaviors.md 8.4
            if self.now < self.entered_at[t.source] + t.spec["after"] or (event is None and t in self.used):
                return False
        return all(self.holds(part) for part in t.spec.get("when", []))

    def holds(self, part):
        kind, what = part
        if kind == "below":
            return self.variables["n"] < what
        inside = any(s.id == what for s in self.configuration)
        return inside if kind == "in" else not inside

    def removeConflictingTransitions(self, enabledTransitions):
        filteredTransitions = []
        for t1 in enabledTransitions:
            t1Preempted, transitionsToRemove = False, []
            for t2 in filteredTransitions:
                if self.computeExitSet([t1]) & self.computeExitSet([t2]):
                    if isDescendant(t1.source, t2.source):
                        transitionsToRemove.append(t2)
                    else:
                        t1Preempted = True
                        break
            if not t1Preempted:
                filteredTransitions = [t for t in filteredTransitions if t not in transitionsToRemove] + [t1]
        return filteredTransitions

    def microstep(self, enabledTransitions):
        for t in enabledTransitions:
            if t.events is None and "after" in t.spec:
                self.used.add(t)  # ours: once per entry
        self.exitStates(enabledTransitions)
        for t in enabledTransitions:
            self.executeContent(t.spec.get("do", []))
        self.enterStates(enabledTransitions)

    def exitStates(self, enabledTransitions):
        statesToExit = self.sorted(self.computeExitSet(enabledTransitions))[::-1]
        for s in statesToExit:
            for h in s.history:
                if h.spec.get("depth") == "deep":
                    kept = [x for x in self.configuration if x.kind in ("atomic", "final") and isDescendant(x, s)]
                else:
                    kept = [x for x in self.configuration if x.parent is s]
                self.historyValue[h] = self.sorted(kept)
        for s in statesToExit:
            self.executeContent(s.spec.get("on_exit", []))
            self.configuration.discard(s)

    def computeExitSet(self, transitions):
        statesToExit = set()
        for t in transitions:
            if t.target:
                domain = self.getTransitionDomain(t)
                statesToExit |= {s for s in self.configuration if isDescendant(s, domain)}
        return statesToExit

    def enterStates(self, enabledTransitions):
        statesToEnter = set()
        if enabledTransitions is None:  # ours: the root is a state
            self.addDescendantStatesToEnter(self.root, statesToEnter)
        else:
            self.computeEntrySet(enabledTransitions, statesToEnter)
        for s in self.sorted(statesToEnter):
            self.configuration.add(s)
            self.entered_at[s] = self.now
            self.used -= set(s.transitions)
            self.executeContent(s.spec.get("on_entry", []))
            if s.kind == "final":
                self.finish(s)

    def finish(self, s):
        if s.parent is self.root:
            self.running = False
            return
        parent, grandparent = s.parent, s.parent.parent
        self.internalQueue.append("done.state." + parent.path())
        if grandparent is None or grandparent.kind != "parallel":
            return
        done = [self.isInFinalState(c) for c in grandparent.states]
        rule = grandparent.spec.get("done", "all")
        if rule == "all":
            holds = all(done)
        elif rule == "any":  # ours: with the first region
            holds = sum(done) == 1
        else:  # ours: with that region
            holds = parent.id == rule
        if holds:
            self.internalQueue.append("done.state." + grandparent.path())

    def computeEntrySet(self, transitions, statesToEnter):
        for t in transitions:
            for s in t.target:
                self.addDescendantStatesToEnter(s, statesToEnter)
            if not t.target:
                continue
            ancestor = self.getTransitionDomain(t)
            for s in self.getEffectiveTargetStates(t.target):
                self.addAncestorStatesToEnter(s, ancestor, statesToEnter)
            if ancestor is self.root and ancestor.kind == "parallel":  # ours: <scxml> is never parallel
                self.addRegions(ancestor, statesToEnter)

    def addDescendantStatesToEnter(self, state, statesToEnter):
        if state.kind == "history":
            found = self.historyValue.get(state) or state.default
            for s in found:
                self.addDescendantStatesToEnter(s, statesToEnter)
            for s in found:
                self.addAncestorStatesToEnter(s, state.parent, statesToEnter)
            return
        statesToEnter.add(state)
        if state.kind == "compound":
            for s in state.initial:
                self.addDescendantStatesToEnter(s, statesToEnter)
            for s in state.initial:
                self.addAncestorStatesToEnter(s, state, statesToEnter)
        elif state.kind == "parallel":
            self.addRegions(state, statesToEnter)

    def addAncestorStatesToEnter(self, state, ancestor, statesToEnter):
        for anc in getProperAncestors(state, ancestor):
            statesToEnter.add(anc)
            if anc.kind == "parallel":
                self.addRegions(anc, statesToEnter)

    def addRegions(self, parallel, statesToEnter):
        for child in parallel.states:
            if not any(isDescendant(s, child) for s in statesToEnter):
                self.addDescendantStatesToEnter(child, statesToEnter)

    def isInFinalState(self, s):
        if s.kind == "compound":
            return any(c.kind == "final" and c in self.configuration for c in s.states)
        return s.kind == "parallel" and all(self.isInFinalState(c) for c in s.states)

    def getTransitionDomain(self, t):
        tstates = self.getEffectiveTargetStates(t.target)
        if t.internal and t.source.kind == "compound" and all(isDescendant(s, t.source) for s in tstates):
            return t.source
        return self.findLCCA([t.source] + tstates)

    def findLCCA(self, stateList):
        for anc in getProperAncestors(stateList[0], None):
            if (anc.kind == "compound" or anc is self.root) and all(isDescendant(s, anc) for s in stateList[1:]):
                return anc
        return self.root  # ours: the root's own transitions

    def getEffectiveTargetStates(self, target):
        targets = []
        for s in target:
            if s.kind != "history":
                found = [s]
            else:
                found = self.historyValue.get(s) or self.getEffectiveTargetStates(s.default)
            targets += [x for x in found if x not in targets]
        return targets

    def executeContent(self, content):
        for action in content:
            if "raise" in action:
                self.internalQueue.append(action["raise"])
                if len(self.internalQueue) > QUEUE:
                    raise OverflowError
            else:
                self.variables["n"] += action["add"]

    def active(self):
        return [s.id for s in self.sorted(self.configuration) if s.kind in ("atomic", "final")]


def heard(pattern, event):
    if pattern == "*" or pattern == event:
        return True
    return pattern.endswith(".*") and (event == pattern[:-2] or event.startswith(pattern[:-1]))


def reference(chart, script):
    machine = Interpreter(chart)
    machine.tick()
    lines = [[None, machine.active()]]
    for step in script:
        if isinstance(step, int):
            for _ in range(step):
                machine.now += 1
                machine.tick()
        else:
            machine.tick(step)
            lines.append([step, machine.active()])
    return lines


class Generator:
    """A random chart; `n` grows with actions and bounds what would loop for ever."""

    EVENTS = ["e", "f", "g.a", "g.b", "i", "j"]
    PATTERNS = ["e", "f", "g.a", "g.b", "i", "j", "g.*", "*", ["e", "j"]]

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.names = []  # every state but the root, with its place
        self.room = self.random.choice([4, 8, 12, 20])
        self.root = self.state(0, "parallel" if self.random.random() < 0.2 else "compound", ())
        self.decorate(self.root, ())

    def state(self, depth, kind, place):
        r = self.random
        spec = {} if kind in ("compound", "atomic") else {"type": kind}
        if kind not in ("compound", "parallel"):
            return spec
        children = []
        for _ in range(r.randint(2, 3) if kind == "parallel" else r.randint(1, 4)):
            compound = depth < 4 and self.room > 0 and r.random() < (0.8 if kind == "parallel" else 0.45)
            child = r.choice(["compound", "compound", "parallel"]) if compound else "atomic"
            children.append(child)
        if kind == "compound" and r.random() < (0.03 if depth == 0 else 0.35):
            children.append("final")
        if r.random() < 0.35:
            children.insert(r.randrange(len(children) + 1), "history")
        if all(c in ("history", "final") for c in children):
            children.append("atomic")
        spec["states"] = {}
        for child in children:
            self.room -= 1
            name = f"s{len(self.names)}"
            here = place + (name,)
            self.names.append((name, here, child))
            spec["states"][name] = self.state(depth + 1, child, here)
        return spec

    def below(self, place):
        return [x for x in self.names if x[1][:len(place)] == place and x[1] != place]

    def targets(self, candidates):
        """One target, or several that can be active together."""
        r = self.random
        name, place, _ = r.choice(candidates)
        chosen = [(name, place)]
        for _ in range(r.choice([0, 0, 0, 1, 2])):
            name, place, _ = r.choice(candidates)
            if all(self.together(place, other) for _, other in chosen):
                chosen.append((name, place))
        return chosen[0][0] if len(chosen) == 1 else [n for n, _ in chosen]

    def together(self, a, b):
        common = 0
        while common < min(len(a), len(b)) and a[common] == b[common]:
            common += 1
        return common < min(len(a), len(b)) and self.kind(a[:common]) == "parallel"

    def kind(self, place):
        return self.root.get("type", "compound") if not place else next(k for _, p, k in self.names if p == place)

    def decorate(self, spec, place):
        r, kind = self.random, self.kind(place)
        if kind == "compound" and r.random() < 0.4:
            options = [x for x in self.below(place) if x[2] != "history" or len(x[1]) > len(place) + 1 or r.random() < 0.3]
            if options:
                spec["initial"] = self.targets(options)
        if kind == "parallel" and r.random() < 0.4:
            spec["done"] = r.choice(["any"] + [n for n, s in spec["states"].items() if s.get("type") != "history"])
        if kind == "history":
            if r.random() < 0.5:
                spec["depth"] = "deep"
            options = [x for x in self.below(place[:-1]) if x[2] != "history"]
            spec["default"] = self.targets(options)  # always: the parent's initial may be a history
            return
        for key in ("on_entry", "on_exit"):
            if r.random() < 0.2:
                spec[key] = self.actions()
        if kind != "final":
            spec["transitions"] = [self.transition(place) for _ in range(r.choice([1, 1, 2, 2, 3]))]
            if place and r.random() < 0.15:
                spec["after"], spec["to"] = r.randint(0, 6), self.targets(self.names)
        for name, child in spec.get("states", {}).items():
            self.decorate(child, place + (name,))

    def actions(self):
        r = self.random
        return [{"raise": r.choice("ij")} if r.random() < 0.25 else {"add": 1} for _ in range(r.randint(1, 2))]

    def transition(self, place):
        r = self.random
        t, how = {}, r.random()
        if how < 0.85:
            t["on"] = r.choice(self.PATTERNS)
            if r.random() < 0.2:
                done = [p for p in [x[1] for x in self.names if x[2] in ("compound", "parallel")]]
                if done:
                    t["on"] = "done.state." + ".".join(r.choice(done))
        if how >= 0.75:
            t["after"] = r.randint(0, 8)
        conditions = []
        if r.random() < 0.3:
            conditions.append([r.choice(["in", "out"]), r.choice([x[0] for x in self.names if x[2] != "history"])])
        if "after" not in t and ("on" not in t or r.random() < 0.2) or r.random() < 0.1:
            conditions.append(["below", r.randint(1, 12)])
        if conditions:
            t["when"] = conditions
        if r.random() < 0.85:
            close = self.below(place) or self.names
            t["to"] = self.targets(close if r.random() < 0.4 else self.names)
            if r.random() < 0.3:
                t["internal"] = True
        if "to" not in t or r.random() < 0.3 or "on" not in t:
            t["do"] = self.actions() + ([{"add": 1}] if "on" not in t else [])
        return t

    def script(self):
        r = self.random
        outside = self.EVENTS + ["unheard", "g", "g.a.b"]
        return [r.randint(1, 6) if r.random() < 0.3 else r.choice(outside) for _ in range(r.randint(6, 14))]


def to_yaml(spec):
    """The chart in the behavior language, as JSON, which is YAML."""
    out = {}
    for key, value in spec.items():
        if key == "states":
            out[key] = {n: to_yaml(s) for n, s in value.items()}
        elif key in ("on_entry", "on_exit", "do"):
            out[key] = [a if "raise" in a else {"set": {"n": f"= $n + {a['add']}"}} for a in value]
        elif key == "after":
            out[key] = f"{value} ms"
        elif key == "transitions":
            out[key] = [to_yaml(t) for t in value]
        elif key == "when":
            texts = {"in": "in({})", "out": "not in({})", "below": "$n < {}"}
            out[key] = " and ".join(texts[k].format(w) for k, w in value)
        else:
            out[key] = value
    return out


def behavior(chart):
    return {"behavior": 1, "parameters": {"n": {"value": 0}}, "machine": {"micro_steps": MICRO_STEPS, **to_yaml(chart)}}


def main():
    program, count, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]) if len(sys.argv) > 3 else 0
    cases = []
    while len(cases) < count:
        seed += 1
        generator = Generator(seed)
        chart, script = generator.root, generator.script()
        try:
            expected = reference(chart, script)
        except OverflowError:
            continue
        if any(a[1] != b[1] for a, b in zip(expected, expected[1:])):  # what stands still shows little
            cases.append((chart, script, expected))
    text = "".join(json.dumps({"behavior": json.dumps(behavior(chart)), "script": script}) + "\n" for chart, script, _ in cases)
    done = subprocess.run([program], input=text, stdout=subprocess.PIPE, text=True, check=True)
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    if len(answers) != count:
        sys.exit(f"{len(answers)} answers to {count} charts")
    different = 0
    for (chart, script, expected), answer in zip(cases, answers):
        if answer != expected:
            different += 1
            if different <= 3:
                print(f"chart: {json.dumps(behavior(chart))}\nscript: {script}\nexpected: {expected}\ngot:      {answer}\n")
    print(f"{different} of {count} random charts differ")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
