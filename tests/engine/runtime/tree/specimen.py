"""Random trees for tests, as data from which a document and a plain py_trees tree are made."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

from hypothesis import strategies as st

SLOTS = {"if_then_else": ("if", "then", "else"), "while_do_else": ("while", "do", "else")}
EVERY_S = 0.25
"""The period of polled decorators; a binary fraction, so that sums of it are exact."""


@dataclass(frozen=True)
class Leaf:
    """Durations and results, one for each activation; the last holds on."""

    commands: bool
    script: tuple[tuple[float, bool], ...]


@dataclass(frozen=True)
class Specimen:
    """One node: a leaf, or a composite or decorator with its arguments."""

    name: str
    kind: str = "leaf"
    leaf: Leaf | None = None
    children: tuple[Specimen, ...] = ()
    arguments: dict[str, Any] = field(default_factory=dict[str, Any])

    def document(self) -> dict[str, Any]:
        """Return the node as a behavior document has it."""
        if self.leaf is not None:
            state = "test.Act" if self.leaf.commands else "test.Check"
            return {"state": state, "name": self.name, "with": {"script": [list(entry) for entry in self.leaf.script]}}
        inside = [child.document() for child in self.children]
        if self.kind in SLOTS:
            return {self.kind: dict(zip(SLOTS[self.kind], inside, strict=False)), "name": self.name}
        group = self.kind in ("sequence", "selector", "parallel")
        below = {"children": inside} if group else {"child": inside[0]}
        return {self.kind: {**self.arguments, **below}, "name": self.name}


def _renamed(specimen: Specimen, name: str) -> Specimen:
    return replace(specimen, name=name)


_STATUSES = ["success", "failure", "running"]
_REMAPS = [(actual, shown) for actual in _STATUSES for shown in _STATUSES if actual != shown]
_DECORATORS = ["inverter", "one_shot", "repeat", "retry", "timeout", "condition", "remap"]


@st.composite
def _leaf(draw: st.DrawFn, durations: list[float]) -> Specimen:
    entry = st.tuples(st.sampled_from(durations), st.booleans())
    return Specimen("leaf", leaf=Leaf(draw(st.booleans()), tuple(draw(st.lists(entry, min_size=1, max_size=3)))))


@st.composite
def _group(draw: st.DrawFn, children: st.SearchStrategy[Specimen]) -> Specimen:
    drawn = draw(st.lists(children, min_size=1, max_size=4))
    inside = tuple(_renamed(child, f"n{index}") for index, child in enumerate(drawn))
    kind = draw(st.sampled_from(["sequence", "selector", "parallel"]))
    if kind != "parallel":
        return Specimen(kind, kind, None, inside, {"memory": draw(st.booleans())})
    chosen = draw(st.lists(st.sampled_from([child.name for child in inside]), min_size=1, unique=True))
    policy = draw(st.sampled_from(["all", "one", chosen]))
    return Specimen(kind, kind, None, inside, {"policy": policy, "synchronise": draw(st.booleans())})


@st.composite
def _branching(draw: st.DrawFn, children: st.SearchStrategy[Specimen]) -> Specimen:
    drawn = draw(st.lists(children, min_size=2, max_size=3))
    kind = draw(st.sampled_from(sorted(SLOTS)))
    return Specimen(kind, kind, None, tuple(_renamed(child, f"n{index}") for index, child in enumerate(drawn)))


@st.composite
def _decorated(draw: st.DrawFn, child: st.SearchStrategy[Specimen], polling: bool) -> Specimen:
    kind = draw(st.sampled_from(_DECORATORS if polling else [each for each in _DECORATORS if each != "condition"]))
    return Specimen(kind, kind, None, (_renamed(draw(child), "child"),), _arguments(draw, kind, polling))


def _arguments(draw: st.DrawFn, kind: str, polling: bool) -> dict[str, Any]:
    match kind:
        case "one_shot":
            return {"policy": draw(st.sampled_from(["completion", "success"]))}
        case "repeat" | "retry":
            return {"times": draw(st.integers(1, 3))}
        case "timeout":
            return {"after": draw(st.sampled_from([0.25, 0.5, 1.0, 1.25]))}
        case "condition":
            return {"status": draw(st.sampled_from(_STATUSES)), "every": EVERY_S}
        case "remap":
            actual, shown = draw(st.sampled_from([pair for pair in _REMAPS if polling or pair[1] != "running"]))
            return {actual: shown, "every": EVERY_S}
        case _:
            return {}


def trees(*, durations: list[float], polling: bool = True) -> st.SearchStrategy[Specimen]:
    """Return random trees whose leaves take these times; without `polling` nothing is asked periodically."""
    return st.recursive(
        _leaf(durations),
        lambda inner: _group(inner) | _decorated(inner, polling) | _branching(inner),
        max_leaves=16,
    )


@st.composite
def conditional_trees(draw: st.DrawFn, *, durations: list[float]) -> Specimen:
    """Return a random `while_do_else` whose condition has parts of its own; nothing in it is asked periodically."""
    leaf = _leaf(durations)
    inner = st.recursive(
        leaf, lambda inside: _group(inside) | _decorated(inside, False) | _branching(inside), max_leaves=5
    )
    condition = _group(inner) | _decorated(inner, False) | _branching(inner)
    drawn = (draw(condition), *draw(st.lists(inner | condition, min_size=1, max_size=2)))
    children = tuple(_renamed(child, f"n{index}") for index, child in enumerate(drawn))
    return Specimen("while_do_else", "while_do_else", None, children)


specimens = trees(durations=[0.0, 0.0, 0.5, 1.0, 2.0])
