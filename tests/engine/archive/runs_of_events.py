"""Runs made up for comparisons: nested visits, as events that an engine would tell."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

from hypothesis import strategies as st

from engine.errors import Cause
from engine.event import Event, NodeEntered, NodeExited, RunEnded, RunStarted


@dataclass(frozen=True)
class MadeVisit:
    """One visit of a node: how long it takes before its children, how it ends, and what it visits inside."""

    name: str
    outcome: str = "done"
    takes_s: float = 1.0
    inside: tuple[MadeVisit, ...] = ()
    cause: str = ""

    def count(self) -> int:
        """The visits in it, with itself."""
        return 1 + sum(each.count() for each in self.inside)


def run_of(*visits: MadeVisit, outcome: str = "good") -> list[Event]:
    """A run of a machine `root` that makes these visits one after another."""
    made = _MadeRun()
    made.add(RunStarted, behavior="b", document="d", parameters={}, seed=1, clock="virtual")
    made.visit("", MadeVisit("root", outcome, 0.0, visits))
    made.add(RunEnded, status="finished", outcome=outcome)
    return made.events


class _MadeRun:
    def __init__(self) -> None:
        self.events: list[Event] = []
        self.visits: dict[str, int] = {}
        self.time_s = 0.0

    def add(self, kind_of: type[Event], /, **fields: object) -> None:
        self.events.append(kind_of(seq=len(self.events) + 1, time_s=self.time_s, **fields))

    def visit(self, above: str, made: MadeVisit) -> None:
        path = f"{above}/{made.name}" if above else made.name
        number = self.visits[path] = self.visits.get(path, 0) + 1
        self.add(NodeEntered, path=path, visit=number, kind="machine" if made.inside else "state", inputs={})
        self.time_s += made.takes_s
        for each in made.inside:
            self.visit(path, each)
        cause = Cause(message=made.cause) if made.cause else None
        self.add(NodeExited, path=path, visit=number, outcome=made.outcome, cause=cause)


def _visits(inside: st.SearchStrategy[tuple[MadeVisit, ...]], most: int) -> st.SearchStrategy[tuple[MadeVisit, ...]]:
    visit = st.builds(
        MadeVisit,
        name=st.sampled_from("abc"),
        outcome=st.sampled_from(("done", "failed")),
        takes_s=st.sampled_from((0.0, 0.5, 2.0)),
        inside=inside,
    )
    return st.lists(visit, max_size=most).map(tuple)


VISITS = _visits(_visits(_visits(st.just(()), 3), 3), 5)
"""What a machine visits, three levels deep."""


def distinct(visits: tuple[MadeVisit, ...]) -> tuple[MadeVisit, ...]:
    """The same without those that follow one of the same name, at all levels."""
    return tuple(
        replace(made, inside=distinct(made.inside))
        for before, made in pairwise((None, *visits))
        if made is not None and (before is None or before.name != made.name)
    )


def without(visits: tuple[MadeVisit, ...], index: int) -> tuple[tuple[MadeVisit, ...], MadeVisit]:
    """Take away the visit of this number, in depth-first order; return what is left, and what was taken."""
    for at, made in enumerate(visits):
        if index == 0:
            return (*visits[:at], *visits[at + 1 :]), made
        if index < made.count():
            inside, taken = without(made.inside, index - 1)
            return (*visits[:at], replace(made, inside=inside), *visits[at + 1 :]), taken
        index -= made.count()
    raise IndexError(index)
