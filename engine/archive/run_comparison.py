"""What differs between two runs: settings, documents, durations, values that were read and written, and ends."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from difflib import unified_diff
from itertools import islice
from typing import Literal

import msgspec

from engine.archive.archive import ArchivedRun
from engine.archive.past_runs import PastRun
from engine.archive.run_alignment import AlignedVisit, Divergence, Visit, align_runs
from engine.event import Event, NodeEntered, RunStarted, UserdataAppended, UserdataWritten
from engine.library.behavior_graph import graph_nodes
from engine.replay import ValueChange, value_changes
from engine.runtime.history.effective_events import effective_events

MAX_VISITS = 4000
"""Aligned visits of one comparison; beyond, those that differ are kept first."""
MAX_DATA = 400
MAX_LINES = 400
"""Lines of the differences of documents."""
_LONGEST_VALUE = 200
_LONGEST_DOCUMENT = 5000

DataKind = Literal["read", "wrote"]


class NodeDifference(msgspec.Struct, frozen=True, kw_only=True):
    """How often a node was visited in each run, and how long all its visits together took."""

    path: str
    visits_left: int
    visits_right: int
    duration_left_s: float
    duration_right_s: float


class DataDifference(ValueChange, frozen=True, kw_only=True):
    """A value that the aligned visit `index` read on its entry or wrote, and that is another one in the right run."""

    index: int
    path: str
    kind: DataKind


class DocumentDifference(msgspec.Struct, frozen=True, kw_only=True):
    """A document of the behavior with another text: the lines of a unified difference, at most `MAX_LINES`."""

    name: str
    lines: tuple[str, ...]


class RunComparison(msgspec.Struct, frozen=True, kw_only=True):
    """Two runs beside one another.

    `visits` are aligned, each container before what is inside; `divergence` is where the runs first differ, null where
    they do not. `settings` are parameters, inputs, seed and clock that differ. `left_out` and `data_left_out` count
    what is not listed. `icons` has the name of the icon of each visited node, as far as its graph is known.
    """

    left: PastRun
    right: PastRun
    divergence: Divergence | None
    visits: tuple[AlignedVisit, ...]
    left_out: int
    nodes: tuple[NodeDifference, ...]
    settings: tuple[ValueChange, ...]
    documents: tuple[DocumentDifference, ...]
    data: tuple[DataDifference, ...]
    data_left_out: int
    icons: dict[str, str]


def compare_runs(left: ArchivedRun, right: ArchivedRun) -> RunComparison:
    """Compare two runs, of one behavior or of two versions of it."""
    events_left, events_right = effective_events(left.events), effective_events(right.events)
    alignment = align_runs(events_left, events_right)
    data = tuple(_data(alignment.visits, _VisitData(events_left), _VisitData(events_right)))
    kept = _kept(alignment.visits, alignment.divergence)
    numbers = {index: number for number, index in enumerate(kept)}
    divergence = alignment.divergence
    listed = tuple(msgspec.structs.replace(each, index=numbers[each.index]) for each in data if each.index in numbers)
    return RunComparison(
        left=left.summary,
        right=right.summary,
        divergence=msgspec.structs.replace(divergence, index=numbers[divergence.index]) if divergence else None,
        visits=tuple(alignment.visits[index] for index in kept),
        left_out=len(alignment.visits) - len(kept),
        nodes=tuple(_nodes(alignment.visits)),
        settings=tuple(value_changes(_settings(left), _settings(right), longest=_LONGEST_VALUE)),
        documents=tuple(_documents(left.documents, right.documents)),
        data=listed[:MAX_DATA],
        data_left_out=len(data) - len(listed[:MAX_DATA]),
        icons=_icons([left, right], {alignment.visits[index].path for index in kept}),
    )


def _icons(runs: Iterable[ArchivedRun], paths: Collection[str]) -> dict[str, str]:
    """Return the icons of nodes by path; of the later run where both have a node."""
    graphs = (run.behavior.graph for run in runs)
    nodes = (node for graph in graphs if graph is not None for node in graph_nodes(graph))
    return {node.path: node.icon for node in nodes if node.path in paths}


def is_different(aligned: AlignedVisit) -> bool:
    """Return whether a visit is missing in one run, or ended otherwise."""
    left, right = aligned.left, aligned.right
    return left is None or right is None or (left.status, left.outcome) != (right.status, right.outcome)


def _kept(visits: Sequence[AlignedVisit], divergence: Divergence | None) -> list[int]:
    if len(visits) <= MAX_VISITS:
        return list(range(len(visits)))
    first = [divergence.index] if divergence is not None else []
    different = (index for index, each in enumerate(visits) if is_different(each))
    kept = dict.fromkeys([*first, *different, *range(len(visits))])
    return sorted(islice(kept, MAX_VISITS))


def _nodes(visits: Iterable[AlignedVisit]) -> Iterator[NodeDifference]:
    by_path: dict[str, tuple[list[Visit], list[Visit]]] = {}
    for aligned in visits:
        lefts, rights = by_path.setdefault(aligned.path, ([], []))
        if aligned.left is not None:
            lefts.append(aligned.left)
        if aligned.right is not None:
            rights.append(aligned.right)
    for path, (lefts, rights) in by_path.items():
        yield NodeDifference(
            path=path,
            visits_left=len(lefts),
            visits_right=len(rights),
            duration_left_s=sum(map(duration_s, lefts)),
            duration_right_s=sum(map(duration_s, rights)),
        )


def duration_s(visit: Visit) -> float:
    """Return how long a visit took; 0 for one that has not ended."""
    return visit.end_s - visit.start_s if visit.end_s is not None else 0.0


def _settings(run: ArchivedRun) -> dict[str, object]:
    started = next((event for event in run.events if isinstance(event, RunStarted)), None)
    if started is None:
        return {}
    return {
        "parameters": started.parameters,
        "inputs": started.inputs,
        "seed": started.seed,
        "clock": started.clock,
    }


def _documents(left: Mapping[str, str], right: Mapping[str, str]) -> Iterator[DocumentDifference]:
    free = MAX_LINES
    for name in dict.fromkeys((*left, *right)):
        before, after = left.get(name, ""), right.get(name, "")
        if before == after:
            continue
        lines_left, lines_right = before.splitlines(), after.splitlines()
        if max(len(lines_left), len(lines_right)) > _LONGEST_DOCUMENT:
            yield DocumentDifference(name=name, lines=("too long to be compared line by line",))
            continue
        lines = tuple(islice(unified_diff(lines_left, lines_right, "left", "right", lineterm=""), 2, 2 + free))
        free -= len(lines)
        yield DocumentDifference(name=name, lines=lines)


class _VisitData:
    """What the visits of a run read and wrote, by the event with which they started."""

    def __init__(self, events: Iterable[Event]) -> None:
        self.read: dict[int, dict[str, object]] = {}
        self.wrote: dict[int, dict[str, object]] = {}
        current: dict[str, int] = {}
        appended: dict[tuple[int, str], list[object]] = {}
        for event in events:
            match event:
                case NodeEntered():
                    current[event.path] = event.seq
                    self.read[event.seq] = event.inputs
                case UserdataWritten():
                    self._written(current, event)[event.key] = event.value
                case UserdataAppended():
                    key = f"{event.key} (appended)"
                    items = appended.setdefault((current.get(event.path, 0), key), [])
                    items.append(event.value)
                    self._written(current, event)[key] = items
                case _:
                    pass

    def _written(self, current: Mapping[str, int], event: UserdataWritten | UserdataAppended) -> dict[str, object]:
        return self.wrote.setdefault(current.get(event.path, 0), {})


def _data(visits: Iterable[AlignedVisit], left: _VisitData, right: _VisitData) -> Iterator[DataDifference]:
    tables: tuple[tuple[DataKind, dict[int, dict[str, object]], dict[int, dict[str, object]]], ...] = (
        ("read", left.read, right.read),
        ("wrote", left.wrote, right.wrote),
    )
    for index, aligned in enumerate(visits):
        if aligned.left is None or aligned.right is None:
            continue
        for kind, lefts, rights in tables:
            changes = value_changes(
                lefts.get(aligned.left.seq, {}), rights.get(aligned.right.seq, {}), longest=_LONGEST_VALUE
            )
            for change in changes:
                yield DataDifference(
                    index=index, path=aligned.path, kind=kind, at=change.at, left=change.left, right=change.right
                )
