"""Random behaviors that are wired without a mistake, and whose userdata may or may not be in order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from hypothesis import strategies as st

Plain = dict[str, Any]
KEYS = ("k", "m")
VALUES = (1, 2.5, "word")
LABELS = ("x", "y")
PARTS = ("sequence", "selector", "parallel", "inverter", "retry", "repeat", "timeout", "if_then_else", "while_do_else")
SLOTS = {"if_then_else": ("if", "then", "else"), "while_do_else": ("while", "do", "else")}


@dataclass(frozen=True)
class Drawn:
    """A node as plain data, how it can end, and which of its ends mean success."""

    node: Plain
    outcomes: tuple[str, ...]
    good: tuple[str, ...]


@st.composite
def behaviors(draw: st.DrawFn, *, safe: bool = False) -> Plain:
    """Draw a behavior document; a `safe` one declares all keys as numbers and writes and reads only numbers."""
    maker = _Maker(draw, safe=safe)
    root = maker.machine(3, root=True)
    declared = dict.fromkeys(KEYS, 0) if safe else maker.userdata()
    return {
        "flexcell": 1,
        "name": "random",
        "userdata": declared,
        "outcomes": list(LABELS),
        "success": ["x"],
        "root": root.node,
    }


class _Maker:
    def __init__(self, draw: st.DrawFn, *, safe: bool) -> None:
        self._draw = draw
        self._safe = safe

    def userdata(self) -> Plain:
        values = VALUES[:2] if self._safe else (*VALUES, None)
        return self._draw(st.dictionaries(st.sampled_from(KEYS), st.sampled_from(values), max_size=1))

    def node(self, depth: int) -> Drawn:
        kinds = [self._put, self._put, self._number, self._text, self._choose]
        if depth > 0:
            containers = [self.machine, self._concurrency, self._foreach, self._tree]
            kinds += [lambda make=make: make(depth - 1) for make in containers]
        return self._draw(st.sampled_from(kinds))()

    def machine(self, depth: int, *, root: bool = False) -> Drawn:
        names = [f"s{i}" for i in range(self._draw(st.integers(1, 4)))]
        states: Plain = {}
        for number, name in enumerate(names):
            drawn = self.node(depth)
            onward = names[number + 1 :] if self._safe else names
            states[name] = {**drawn.node, **self._wired(drawn, [*onward, *LABELS], in_machine=True, root=root)}
        if self._safe or root:
            # Something leads to every label, and everything leads on: nothing is left over.
            states[names[-1]]["transitions"] |= dict.fromkeys(list(states[names[-1]]["transitions"])[:1], "x")
        initial = names[0] if self._safe else self._draw(st.sampled_from(names))
        kind = self._draw(st.sampled_from(("machine", "priority"))) if not root else "machine"
        scope = {"userdata": self.userdata()} if not root else {}
        used = {to for state in states.values() for to in _targets(state)}
        outcomes = tuple(label for label in LABELS if label in used) or LABELS
        return Drawn({kind: {"initial": initial, "states": states, **scope}}, outcomes, outcomes[:1])

    def _wired(self, drawn: Drawn, targets: Sequence[str], *, in_machine: bool, root: bool = False) -> Plain:
        """Draw transitions, retry, timeout and on_error of a node."""
        to = st.sampled_from(list(targets))
        found: Plain = {"transitions": {outcome: self._draw(to) for outcome in drawn.outcomes}} if in_machine else {}
        if self._draw(st.integers(0, 4)) == 0:
            found["timeout"] = {"after": self._draw(st.sampled_from((0.5, 1.5, 3.5))), "to": self._draw(to)}
        if self._draw(st.integers(0, 6)) == 0:
            found["retry"] = {"times": 1, "outcomes": [self._draw(st.sampled_from(drawn.outcomes))]}
        if root and self._draw(st.integers(0, 3)) == 0:
            # Only to where the run ends, or a node that fails at once would fail for ever.
            found["on_error"] = self._draw(st.sampled_from(LABELS))
        return found

    def _concurrency(self, depth: int) -> Drawn:
        names = [f"b{i}" for i in range(self._draw(st.integers(1, 3)))]
        drawn = {name: self.node(depth) for name in names}
        states = {name: {**each.node, **self._wired(each, LABELS, in_machine=False)} for name, each in drawn.items()}
        conditions: list[Plain] = []
        for _ in range(self._draw(st.integers(0, 2))):
            some = self._draw(st.lists(st.sampled_from(names), min_size=1, unique=True))
            when = {name: self._draw(st.sampled_from(drawn[name].outcomes)) for name in some}
            count = {"at_least": self._draw(st.integers(1, len(some)))} if self._draw(st.booleans()) else {}
            others = [name for name in names if name not in some]
            if not others or self._draw(st.integers(0, 2)):
                conditions.append({self._draw(st.sampled_from(LABELS)): {**when, **count}})
            else:
                preempted = self._draw(st.lists(st.sampled_from(others), min_size=1, max_size=2, unique=True))
                conditions.append({"preempt": preempted, "when": {**when, **count}})
        container = {"states": states, "conditions": conditions, "otherwise": "x", "userdata": self.userdata()}
        good = [next(iter(rule)) for rule in conditions if "preempt" not in rule]
        outcomes = tuple(dict.fromkeys([*good, "x"]))
        return Drawn({"concurrency": container}, outcomes, tuple(good) or outcomes)

    def _foreach(self, depth: int) -> Drawn:
        child = self.node(depth)
        following = self._draw(st.lists(st.sampled_from(child.outcomes), min_size=1, unique=True))
        rounds: Plain = {
            "items": self._draw(st.lists(st.sampled_from(VALUES[:2] if self._safe else VALUES), max_size=3)),
            "as": self._draw(st.sampled_from((*KEYS, "item"))),
            "child": child.node,
            "next": following,
            "userdata": self.userdata(),
        }
        if not self._safe:
            rounds["collect"] = self._draw(st.dictionaries(st.sampled_from(KEYS), st.just("all"), max_size=1))
        return Drawn({"foreach": rounds}, ("exhausted", "broken"), ("exhausted",))

    def _tree(self, depth: int) -> Drawn:
        return Drawn({"tree": self._part(depth, 2)}, ("success", "failure"), ("success",))

    def _part(self, depth: int, levels: int) -> Plain:
        if levels == 0 or self._draw(st.booleans()):
            return self.node(depth).node
        part = self._composite(depth, levels)
        if self._draw(st.integers(0, 3)) == 0:
            to = self._draw(st.sampled_from(("success", "failure", "skipped")))
            part["guard"] = {"when": self._draw(st.sampled_from(("${1 < 2}", "${1 > 2}"))), "to": to}
        if not self._safe and self._draw(st.integers(0, 3)) == 0:
            when = self._draw(st.sampled_from(("on_success", "on_failure", "on_halted", "always")))
            part["post"] = {when: {self._draw(st.sampled_from(KEYS)): self._draw(st.sampled_from(VALUES))}}
        return part

    def _composite(self, depth: int, levels: int) -> Plain:
        kind = self._draw(st.sampled_from(PARTS))
        if kind in SLOTS:
            roles = SLOTS[kind][: self._draw(st.integers(2, 3))]
            return {kind: {role: self._part(depth, levels - 1) for role in roles}}
        if kind in ("sequence", "selector"):
            children = [self._part(depth, levels - 1) for _ in range(self._draw(st.integers(1, 3)))]
            return {kind: {"children": children, "memory": self._draw(st.booleans())}}
        if kind == "parallel":
            children = [self._part(depth, levels - 1) for _ in range(self._draw(st.integers(1, 3)))]
            return {kind: {"children": children, "policy": self._draw(st.sampled_from(("all", "one")))}}
        child = self._part(depth, levels - 1)
        extra = {"retry": {"times": 1}, "repeat": {"times": 2}, "timeout": {"after": 2.5}}.get(kind, {})
        return {kind: {**extra, "child": child}}

    def _put(self) -> Drawn:
        value = self._draw(st.sampled_from(VALUES[:2] if self._safe else (*VALUES, "${k}", "${m}")))
        node = {"state": "data.Put", "with": {"value": value}, "out": {"value": self._draw(st.sampled_from(KEYS))}}
        return Drawn(node, ("done", "none"), ("done",))

    def _number(self) -> Drawn:
        node = {"state": "data.Number", "in": {"x": self._draw(st.sampled_from(KEYS))}}
        return Drawn(node, ("low", "high"), ("high",))

    def _text(self) -> Drawn:
        text = "${string(%s)}" if self._safe else "${%s}"
        return Drawn(
            {"state": "data.Text", "with": {"text": text % self._draw(st.sampled_from(KEYS))}}, ("done",), ("done",)
        )

    def _choose(self) -> Drawn:
        return Drawn({"state": "data.Choose"}, ("a", "b"), ("a",))


def _targets(state: Plain) -> list[str]:
    found = [*state["transitions"].values()]
    found += [state["timeout"]["to"]] if "timeout" in state else []
    return [*found, *([state["on_error"]] if "on_error" in state else [])]
