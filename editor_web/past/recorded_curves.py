"""Curves of a recorded run: the numeric fields of its topics over any part of its time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from itertools import pairwise
from math import inf
from pathlib import Path
from typing import Self

import msgspec

from editor_web.telemetry.bus_bodies import TopicFields
from editor_web.telemetry.plot_signals import number_at, path_of, signal_fields
from engine.errors import RecordingError
from engine.recording import IndexedRecording

MAX_FIELDS = 64
"""Curves of one request."""
MAX_CELLS = 2000
_MAX_MESSAGES = 20_000
"""Messages of one topic that are read for one request; of more, as many lie evenly among all."""


class RecordedFields(msgspec.Struct, frozen=True, kw_only=True):
    """The topics of a recording with their numeric fields, and the time that it covers on the clock of the run."""

    topics: tuple[TopicFields, ...]
    from_s: float
    until_s: float


class RecordedCurves(msgspec.Struct, frozen=True, kw_only=True):
    """Values of fields at the same times, seconds of the run; null before the first message.

    The time range is divided into cells of two times each: their values are the least and the most in the cell, in the
    order in which they were. So no peak is lost, however long the range is.
    """

    times_s: tuple[float, ...]
    fields: tuple[str, ...]
    columns: tuple[tuple[float | None, ...], ...]


class RecordedPieces:
    """The open recordings of one run, oldest first, for one thread; a context manager.

    Args:
        files: The recordings; a resumed run has several.

    Raises:
        RecordingError: there is none, or one cannot be read.
    """

    def __init__(self, files: Sequence[Path]) -> None:
        if not files:
            raise RecordingError(
                "there is no recording of this run", hint="runs are recorded by `flexcell run --record FILE`"
            )
        with ExitStack() as stack:
            self._pieces = [stack.enter_context(IndexedRecording.open(file)) for file in files]
            self._open = stack.pop_all()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._open.close()

    @property
    def topics(self) -> dict[str, str]:
        """The topics, each with the type of its messages."""
        return {topic: kind for piece in self._pieces for topic, kind in piece.topics.items()}

    def count(self, topic: str) -> int:
        """Return how many messages of a topic there are in the recording that has most."""
        return max(piece.count(topic) for piece in self._pieces)

    def fields(self) -> RecordedFields:
        """Return what can be drawn, by topic."""
        listed = ((topic, kind, signal_fields(self._last(topic))) for topic, kind in sorted(self.topics.items()))
        return RecordedFields(
            topics=tuple(
                TopicFields(topic=topic, type=kind, fields=fields) for topic, kind, fields in listed if fields
            ),
            from_s=self._pieces[0].span_s[0],
            until_s=self._pieces[-1].span_s[1],
        )

    def curves(self, fields: Sequence[str], *, from_s: float, until_s: float, cells: int) -> RecordedCurves:
        """Return the curves of fields, each written `topic:path`, over a time range in seconds of the run."""
        width_s = max(until_s - from_s, 1e-6) / cells
        by_topic: dict[str, list[str]] = {}
        for field in fields:
            by_topic.setdefault(field.rpartition(":")[0], []).append(field)
        columns: dict[str, tuple[float | None, ...]] = {}
        for topic, ids in by_topic.items():
            paths = [path_of(field.rpartition(":")[2]) for field in ids]
            tables = [_Cells(cells) for _ in ids]
            for at_s, data in self.messages(topic, from_s, until_s):
                message = msgspec.json.decode(data)
                cell = min(cells - 1, int((at_s - from_s) / width_s)) if at_s >= from_s else -1
                for path, table in zip(paths, tables, strict=True):
                    number = number_at(message, path)
                    if number is not None:
                        table.take(cell, number)
            columns.update(zip(ids, (table.column() for table in tables), strict=True))
        return RecordedCurves(
            times_s=tuple(from_s + (row + 0.5) * width_s / 2 for row in range(2 * cells)),
            fields=tuple(fields),
            columns=tuple(columns[field] for field in fields),
        )

    def messages(
        self, topic: str, from_s: float = -inf, until_s: float = inf, *, most: int = _MAX_MESSAGES
    ) -> Iterator[tuple[float, bytes]]:
        """Yield times and data of the messages of a topic, of each recording as `IndexedRecording.between` does."""
        starts_s = [*(piece.span_s[0] for piece in self._pieces), inf]
        for piece, (start_s, end_s) in zip(self._pieces, pairwise(starts_s), strict=True):
            if start_s <= until_s and end_s > from_s:
                # A resumed run went on before the end of its earlier recording.
                until = min(until_s, end_s)
                yield from piece.between(topic, max(from_s, start_s), until, most=most)

    def _last(self, topic: str) -> object:
        for piece in reversed(self._pieces):
            stored = piece.at(topic, piece.span_s[1])
            if stored is not None:
                return msgspec.json.decode(stored.data)
        return None


class _Cells:
    """The least and the most of one field in each cell, and its value before the first."""

    def __init__(self, count: int) -> None:
        self._count = count
        self._before: float | None = None
        self._found: dict[int, tuple[float, float, float]] = {}
        """By cell: the first of the two extremes, the second one, and the last value."""

    def take(self, cell: int, number: float) -> None:
        """Take the next value, in order."""
        if cell < 0:
            self._before = number
            return
        known = self._found.get(cell)
        if known is None:
            self._found[cell] = (number, number, number)
            return
        first, second, _ = known
        low, high = min(first, second), max(first, second)
        if number < low:
            first, second = high, number
        elif number > high:
            first, second = low, number
        self._found[cell] = (first, second, number)

    def column(self) -> tuple[float | None, ...]:
        """Return two values for each cell; a cell without any goes on with the value before it."""
        rows: list[float | None] = []
        held = self._before
        for cell in range(self._count):
            found = self._found.get(cell)
            rows += (found[0], found[1]) if found is not None else (held, held)
            held = found[2] if found is not None else held
        return tuple(rows)
