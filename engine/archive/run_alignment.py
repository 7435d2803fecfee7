"""Aligns the visits of two runs of a behavior, container by container, and finds where they first diverge."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Literal

import msgspec

from engine.archive.activation_intervals import ActivationInterval, ActivationIntervals
from engine.archive.sequence_alignment import align_sequences
from engine.cause_chain import describe_cause
from engine.event import Event
from engine.runtime.history import RunReducer
from engine.runtime.history.effective_events import effective_events

_NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
_ENDLESS = 2**62


class Visit(ActivationInterval, frozen=True, kw_only=True, gc=False):
    """One activation of a node, with the causes of its failure, from the outermost."""

    path: str
    cause: str


class AlignedVisit(msgspec.Struct, frozen=True, kw_only=True):
    """A visit of a node in the left run and the same one in the right run; null in the run that does not have it."""

    path: str
    left: Visit | None
    right: Visit | None


class Divergence(msgspec.Struct, frozen=True, kw_only=True):
    """Where two runs first differ: a `visit` that one does not have, another `outcome`, or another `cause` of it.

    `index` is that of the aligned visit. `left_s` and `right_s` are when it shows in each run, null where the run does
    not have the visit.
    """

    kind: Literal["visit", "outcome", "cause"]
    path: str
    index: int
    left_s: float | None
    right_s: float | None
    text: str


class RunAlignment(msgspec.Struct, frozen=True, kw_only=True):
    """The visits of two runs, each container before what is inside, and their first divergence."""

    visits: tuple[AlignedVisit, ...]
    divergence: Divergence | None


@dataclass(kw_only=True)
class _Activation:
    """A visit with the visits inside, in the order of their starts."""

    visit: Visit
    inside: list[_Activation] = field(default_factory=list["_Activation"])

    @property
    def end(self) -> int:
        return self.visit.end_seq or _ENDLESS


@dataclass(frozen=True, kw_only=True)
class _Found:
    """A divergence with the index of its visit."""

    index: int
    kind: Literal["visit", "outcome", "cause"]


def align_runs(left: Iterable[Event], right: Iterable[Event]) -> RunAlignment:
    """Align the visits of two runs by their events.

    Children that run one after another are aligned as sequences of their paths. Children that were active side by side
    have no order among each other: those of each path are aligned by themselves.
    """
    alignment = _Alignment()
    found = alignment.align(_activations(left), _activations(right))
    visits = tuple(alignment.visits)
    return RunAlignment(visits=visits, divergence=_divergence(visits, found) if found is not None else None)


def visits_of(events: Iterable[Event]) -> tuple[Visit, ...]:
    """Return the visits of a run in the order of their starts, without those that a resume has taken back."""
    effective = effective_events(events)
    reducer, intervals = RunReducer(), ActivationIntervals()
    for event in effective:
        change = reducer.apply(event)
        if change is not None and change.nodes:
            intervals.take(event, change.nodes)
    causes = {event.seq: describe_cause(cause) for event in effective if (cause := getattr(event, "cause", None))}
    visits = [
        Visit(**msgspec.structs.asdict(interval), path=path, cause=causes.get(interval.end_seq, ""))
        for path, of_path in intervals.of(from_s=0.0, until_s=float("inf"), after_seq=0).items()
        for interval in of_path
    ]
    return tuple(sorted(visits, key=lambda visit: (visit.seq, visit.path)))


class _Alignment:
    """The aligned visits so far, each container before what is inside."""

    def __init__(self) -> None:
        self.visits: list[AlignedVisit] = []

    def align(self, lefts: Sequence[_Activation], rights: Sequence[_Activation]) -> _Found | None:
        """Append the visits of one container in both runs; return the first divergence."""
        if not (_are_side_by_side(lefts) or _are_side_by_side(rights)):
            return self._align_in_order(lefts, rights)
        branches = dict.fromkeys(each.visit.path for each in (*lefts, *rights))
        found = [
            self._align_in_order(
                [each for each in lefts if each.visit.path == path],
                [each for each in rights if each.visit.path == path],
            )
            for path in branches
        ]
        start_left_s, start_right_s = _start_s(lefts), _start_s(rights)
        return min(
            (each for each in found if each is not None),
            key=lambda each: self._shown_s(each, start_left_s, start_right_s),
            default=None,
        )

    def _align_in_order(self, lefts: Sequence[_Activation], rights: Sequence[_Activation]) -> _Found | None:
        first: _Found | None = None
        pairs = align_sequences([each.visit.path for each in lefts], [each.visit.path for each in rights])
        for at_left, at_right in pairs:
            found = self._pair(
                lefts[at_left] if at_left is not None else None, rights[at_right] if at_right is not None else None
            )
            first = first or found
        return first

    def _pair(self, left: _Activation | None, right: _Activation | None) -> _Found | None:
        known = left or right
        if known is None:
            return None
        index = len(self.visits)
        aligned = AlignedVisit(
            path=known.visit.path,
            left=left.visit if left is not None else None,
            right=right.visit if right is not None else None,
        )
        self.visits.append(aligned)
        inside = self.align(left.inside if left is not None else (), right.inside if right is not None else ())
        if aligned.left is None or aligned.right is None:
            return _Found(index=index, kind="visit")
        # What went otherwise inside comes before how the container ended.
        return inside or _difference(index, aligned.left, aligned.right)

    def _shown_s(self, found: _Found, start_left_s: float, start_right_s: float) -> float:
        """Return how long after the start of both it shows, at the earliest."""
        left_s, right_s = _times_s(self.visits[found.index], found.kind)
        times_s = [
            *([left_s - start_left_s] if left_s is not None else []),
            *([right_s - start_right_s] if right_s is not None else []),
        ]
        return min(times_s)


def _activations(events: Iterable[Event]) -> list[_Activation]:
    """Return the outermost activations of a run, each with those inside."""
    roots: list[_Activation] = []
    by_path: dict[str, list[_Activation]] = {}
    visits = visits_of(events)
    for visit in visits:
        by_path.setdefault(visit.path, []).append(_Activation(visit=visit))
    taken = dict.fromkeys(by_path, 0)
    for visit in visits:
        activation = by_path[visit.path][taken[visit.path]]
        taken[visit.path] += 1
        container = _container_of(activation, by_path)
        (container.inside if container is not None else roots).append(activation)
    return roots


def _container_of(activation: _Activation, by_path: Mapping[str, list[_Activation]]) -> _Activation | None:
    """Return the activation of the nearest node above that was active when it started, or later during it."""
    above = activation.visit.path.rpartition("/")[0]
    while above:
        candidates = by_path.get(above, ())
        # The status of a tree node is told after its leaf has started.
        for seq in (activation.visit.seq, activation.end):
            count = bisect_right(candidates, seq, key=lambda each: each.visit.seq)
            if count and candidates[count - 1].end >= activation.visit.seq:
                return candidates[count - 1]
        above = above.rpartition("/")[0]
    return None


def _are_side_by_side(activations: Sequence[_Activation]) -> bool:
    return any(
        before.end > after.visit.seq and before.visit.path != after.visit.path
        for before, after in pairwise(activations)
    )


def _start_s(activations: Sequence[_Activation]) -> float:
    return min((each.visit.start_s for each in activations), default=0.0)


def _difference(index: int, left: Visit, right: Visit) -> _Found | None:
    if (left.status, left.outcome) != (right.status, right.outcome):
        return _Found(index=index, kind="outcome")
    # Two measurements of one cause are never equal.
    if _NUMBER.sub("#", left.cause) != _NUMBER.sub("#", right.cause):
        return _Found(index=index, kind="cause")
    return None


def _times_s(aligned: AlignedVisit, kind: str) -> tuple[float | None, float | None]:
    if kind == "visit":
        return (
            aligned.left.start_s if aligned.left is not None else None,
            aligned.right.start_s if aligned.right is not None else None,
        )
    return (
        _end_s(aligned.left) if aligned.left is not None else None,
        _end_s(aligned.right) if aligned.right is not None else None,
    )


def _end_s(visit: Visit) -> float:
    return visit.end_s if visit.end_s is not None else visit.start_s


def _divergence(visits: Sequence[AlignedVisit], found: _Found) -> Divergence:
    aligned = visits[found.index]
    left_s, right_s = _times_s(aligned, found.kind)
    return Divergence(
        kind=found.kind,
        path=aligned.path,
        index=found.index,
        left_s=left_s,
        right_s=right_s,
        text=_text(aligned, found),
    )


def _text(aligned: AlignedVisit, found: _Found) -> str:
    left, right, path = aligned.left, aligned.right, aligned.path
    if left is None or right is None:
        known, side = (left, "left") if left is not None else (right, "right")
        visit = f", visit {known.visit}," if known is not None and known.visit > 1 else ""
        return f"{path}{visit} was entered in the {side} run only"
    if found.kind == "cause":
        return f"{path} failed for another reason: left {_quoted(left.cause)}, right {_quoted(right.cause)}"
    return f"{path} {_ended(left)} in the left run, and {_ended(right)} in the right run"


def _quoted(cause: str) -> str:
    return f"“{cause}”" if cause else "without a cause"


def _ended(visit: Visit) -> str:
    match visit.status:
        case "active":
            return "had not ended"
        case "stopped":
            return f"was left for {visit.outcome}" if visit.outcome else "was stopped"
        case "failed" if not visit.outcome:
            return "ended with an error"
        case status:
            return f"ended with {visit.outcome or status}"
