"""The reference for SKIPPED: nodes as BehaviorTree.CPP 4 ticks them, at every instant at which something ends."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

from hypothesis import strategies as st

from tests.engine.runtime.tree.course import Course
from tests.engine.runtime.tree.specimen import SLOTS, Leaf

IDLE, RUNNING, SUCCESS, FAILURE, SKIPPED = "idle", "running", "success", "failure", "skipped"
TARGETS = (SUCCESS, FAILURE, SKIPPED)


@dataclass(frozen=True)
class Guarded:
    """A node with a guard that is open or closed for good: `to` is where it leads when it is closed."""

    name: str
    kind: str = "leaf"
    leaf: Leaf | None = None
    children: tuple[Guarded, ...] = ()
    arguments: dict[str, Any] = field(default_factory=dict[str, Any])
    to: str | None = None

    def document(self) -> dict[str, Any]:
        """Return the node as a behavior document has it."""
        guard = {"guard": {"when": "${false}", "to": self.to}} if self.to is not None else {}
        if self.leaf is not None:
            state = "test.Act" if self.leaf.commands else "test.Check"
            script = [list(entry) for entry in self.leaf.script]
            return {"state": state, "name": self.name, "with": {"script": script}, **guard}
        inside = [child.document() for child in self.children]
        if self.kind == "guard":
            when = {"when": "${false}", "to": self.to} if self.to is not None else {"when": "${true}"}
            return {"guard": {**when, "child": inside[0]}, "name": self.name}
        if self.kind in SLOTS:
            return {self.kind: dict(zip(SLOTS[self.kind], inside, strict=False)), "name": self.name, **guard}
        below = {"child": inside[0]} if self.kind == "inverter" else {"children": inside}
        return {self.kind: {**self.arguments, **below}, "name": self.name, **guard}


class Ticked:
    """One node at work."""

    def __init__(self, specimen: Guarded, path: str, world: World) -> None:
        self.specimen = specimen
        self.path = f"{path}/{specimen.name}".removeprefix("/")
        self.world = world
        self.status = IDLE
        self.children = [Ticked(child, self.path, world) for child in specimen.children]
        self.index = 0
        self.ended: dict[int, str] = {}
        self.count = 0
        self.ends_s: float | None = None
        self.offered = False

    def execute(self) -> str:
        """Tick it, unless its guard is closed."""
        said = self.specimen
        if said.leaf is None and said.to is not None and self.status != RUNNING:
            self.halt()
            self.status = said.to
        else:
            self.status = self._tick()
        return self.status

    def halt(self) -> None:
        """Bring it and everything inside to rest."""
        for child in self.children:
            child.halt()
        self.status, self.index, self.ends_s = IDLE, 0, None
        self.ended.clear()
        if self in self.world.pending:
            self.world.pending.remove(self)

    def begin(self) -> None:
        """Begin the work of a leaf."""
        self.offered = False
        if self.specimen.to is not None:
            self.ends_s = self.world.now_s
            return
        script = self._script()
        self.count += 1
        self.ends_s = self.world.now_s + script[min(self.count, len(script)) - 1][0]
        self.world.begun.append((self.world.now_s, self.path))

    def leaves(self) -> Iterator[Ticked]:
        """Go through the leaves below."""
        if not self.children:
            yield self
        for child in self.children:
            yield from child.leaves()

    def _script(self) -> tuple[tuple[float, bool], ...]:
        assert self.specimen.leaf is not None
        return self.specimen.leaf.script

    def _tick(self) -> str:
        match self.specimen.kind:
            case "leaf":
                return self._tick_leaf()
            case "sequence":
                return self._tick_line(onward=SUCCESS)
            case "selector":
                return self._tick_line(onward=FAILURE)
            case "parallel":
                return self._tick_parallel()
            case "inverter":
                said = self.children[0].execute()
                return {SUCCESS: FAILURE, FAILURE: SUCCESS}.get(said, said)
            case "guard":
                return self.children[0].execute()
            case _:
                return self._tick_branching()

    def _tick_leaf(self) -> str:
        assert self.specimen.leaf is not None
        if self.status != RUNNING:
            if self.specimen.leaf.commands:
                self.world.pending.append(self)
                return RUNNING
            self.begin()
        if self.ends_s is None or self.ends_s > self.world.now_s:
            return RUNNING
        self.ends_s = None
        if self.specimen.to is not None:
            return self.specimen.to
        script = self._script()
        return SUCCESS if script[min(self.count, len(script)) - 1][1] else FAILURE

    def _tick_line(self, onward: str) -> str:
        memory = self.specimen.arguments["memory"]
        if self.status != RUNNING:
            self.index = 0
            self.ended.clear()
        first = self.index if memory else 0
        for number in range(first, len(self.children)):
            self.index = number
            said = self.children[number].execute()
            if said == RUNNING or said not in (onward, SKIPPED):
                if not memory:
                    for later in self.children[number + 1 :]:
                        later.halt()
                return said
            self.ended[number] = said
        skipped = all(self.ended[number] == SKIPPED for number in range(len(self.children)))
        return SKIPPED if skipped else onward

    def _tick_parallel(self) -> str:
        if self.status != RUNNING:
            for child in self.children:
                child.halt()
            self.ended.clear()
        counts = "success_count" in self.specimen.arguments
        for number, child in enumerate(self.children):
            if number not in self.ended:
                said = child.execute()
                if said != RUNNING:
                    self.ended[number] = said
        ends = list(self.ended.values())
        if len(ends) == len(self.children) and all(end == SKIPPED for end in ends):
            return SKIPPED
        active = len(self.children) - ends.count(SKIPPED)
        needed = self.specimen.arguments["success_count"] if counts else active
        left = active - ends.count(FAILURE)
        verdict = RUNNING
        if counts and ends.count(SUCCESS) >= needed:
            verdict = SUCCESS
        elif FAILURE in ends or left < needed:
            verdict = FAILURE
        elif ends.count(SUCCESS) >= needed:
            verdict = SUCCESS
        if verdict != RUNNING:
            for number, child in enumerate(self.children):
                if number not in self.ended:
                    child.halt()
        return verdict

    def _tick_branching(self) -> str:
        reactive = self.specimen.kind == "while_do_else"
        if self.status != RUNNING:
            self.halt()
        if reactive or self.index == 0:
            said = self.children[0].execute()
            if said == RUNNING:
                return RUNNING
            self.index = 1 if said == SUCCESS else 2
            other = 3 - self.index
            if reactive and other < len(self.children):
                self.children[other].halt()
        if self.index >= len(self.children):
            for child in self.children:
                child.halt()
            return FAILURE
        return self.children[self.index].execute()


@dataclass
class World:
    """The time, and what was begun when."""

    now_s: float = 0.0
    begun: list[tuple[float, str]] = field(default_factory=list[tuple[float, str]])
    pending: list[Ticked] = field(default_factory=list[Ticked])


def run_guarded(specimen: Guarded, *, until_s: float, instant_limit: int) -> Course:
    """Tick a tree in step with its scripts; a root that is skipped succeeds."""
    world = World()
    root = Ticked(specimen, "", world)
    instants = 0
    while world.now_s < until_s:
        said = root.execute()
        for leaf in world.pending:
            leaf.begin()
        world.pending.clear()
        if said != RUNNING:
            return Course(SUCCESS if said == SKIPPED else said, world.now_s, tuple(world.begun))
        due = [leaf for leaf in root.leaves() if leaf.ends_s is not None and not leaf.offered]
        due_s = min((leaf.ends_s for leaf in due if leaf.ends_s is not None), default=until_s)
        instants = instants + 1 if due_s <= world.now_s else 0
        if instants >= instant_limit:
            return Course(None, world.now_s, tuple(world.begun), endless=True)
        world.now_s = max(world.now_s, due_s)
        for leaf in due:
            # What a tick does not come to is not the reason for another one.
            leaf.offered = leaf.ends_s is not None and leaf.ends_s <= world.now_s
    return Course(None, until_s, tuple(world.begun))


@st.composite
def _leaf(draw: st.DrawFn) -> Guarded:
    entry = st.tuples(st.sampled_from([0.0, 0.0, 0.5, 1.0, 2.0]), st.booleans())
    script = tuple(draw(st.lists(entry, min_size=1, max_size=3)))
    return Guarded("leaf", leaf=Leaf(draw(st.booleans()), script), to=draw(_closed))


_closed = st.sampled_from([None, None, None, SKIPPED, SKIPPED, SUCCESS, FAILURE])


@st.composite
def _part(draw: st.DrawFn, inner: st.SearchStrategy[Guarded]) -> Guarded:
    kind = draw(st.sampled_from(["sequence", "selector", "parallel", "inverter", "guard", *SLOTS]))
    least, most = {"inverter": (1, 1), "guard": (1, 1), **dict.fromkeys(SLOTS, (2, 3))}.get(kind, (1, 4))
    drawn = draw(st.lists(inner, min_size=least, max_size=most))
    children = tuple(replace(child, name=f"n{number}") for number, child in enumerate(drawn))
    arguments: dict[str, Any] = {}
    if kind in ("sequence", "selector"):
        arguments = {"memory": draw(st.booleans())}
    elif kind == "parallel" and draw(st.booleans()):
        arguments = {"success_count": draw(st.integers(1, len(children)))}
    return Guarded(kind, kind, None, children, arguments, draw(_closed))


guarded_trees = st.recursive(_leaf(), _part, max_leaves=12)
