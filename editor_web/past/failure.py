"""Failure of a run: the cause chain with hints, the node where it originated, and the events of that node."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

import msgspec

from editor_web.past.state_history import RunStateHistory
from engine.cause_chain import cause_line, links_from_root
from engine.errors import Cause, CauseLine, FlexcellError
from engine.event import Event
from engine.runtime.history import LogLine, NodeStep, log_line

AROUND = 20
_AROUND_KINDS = frozenset(
    {"goal", "goal_finished", "call", "answer", "received", "userdata", "log", "fault", "retry", "exited", "diverted"}
)


class RunFailure(msgspec.Struct, frozen=True, kw_only=True):
    """A failed run: the failure originated at event `seq`, at node `path` (empty if in no node).

    `entered_seq` is the entry into that node, from where the run can be tried again; 0 if it is in no node.
    `hint` says what to do, `links` are the causes without it. `steps` say how the nodes from the root to the origin
    ended, `around` are the requests, answers and writes of the origin.
    """

    seq: int
    entered_seq: int
    time_s: float
    path: str
    text: str
    hint: str
    links: tuple[CauseLine, ...]
    steps: tuple[LogLine, ...]
    around: tuple[LogLine, ...]


def failure_of(history: RunStateHistory) -> RunFailure | None:
    """Return the failure of a run that failed; None if it has not ended."""
    end = history.now.end
    if end is None:
        return None
    events, steps = history.events(1, history.last_seq), history.steps
    described = tuple(map(_link_and_hint, links_from_root(end.cause)))
    links = tuple(link for link, _ in described)
    origin = _origin(events, steps, end, end.cause)
    path = _path(origin)
    first = links[0] if links else None
    return RunFailure(
        seq=origin.seq,
        entered_seq=_entry(events, steps, path, origin.seq).seq if path else 0,
        time_s=origin.time_s,
        path=path,
        text=first.message if first is not None else log_line(end).text,
        hint=next((hint for _, hint in described if hint), ""),
        links=links,
        steps=tuple(_steps(events, steps, path, origin.seq)),
        around=_around(events, steps, path, origin.seq),
    )


def _origin(events: Sequence[Event], steps: Mapping[int, NodeStep], end: Event, cause: Cause | None) -> Event:
    """Return the origin: the deepest and earliest event of the same cause, in the last visit of its node."""
    if cause is not None:
        root = cause.chain()[-1]
        origin = _innermost(events, steps, lambda event: _root_of(event) == root) or _innermost(
            events, steps, lambda event: _is_end_of_node(steps, event) and _path(event) == root.where
        )
        if origin is not None:
            return origin
    return _innermost(events, steps, lambda event: _is_end_of_node(steps, event)) or end


def _innermost(events: Sequence[Event], steps: Mapping[int, NodeStep], fits: Callable[[Event], bool]) -> Event | None:
    origin: Event | None = None
    for event in reversed(events):
        path = _path(event)
        if origin is not None and path == _path(origin) and _is_entry(steps, event):
            break
        inside = origin is None or path == _path(origin) or path.startswith(f"{_path(origin)}/")
        if path and inside and fits(event):
            origin = event
    return origin


def _is_entry(steps: Mapping[int, NodeStep], event: Event) -> bool:
    step = steps.get(event.seq)
    return step is not None and step.kind == "entered"


def _is_end_of_node(steps: Mapping[int, NodeStep], event: Event) -> bool:
    step = steps.get(event.seq)
    return step is not None and step.kind == "ended" and not step.is_preempted


def _root_of(event: Event) -> Cause | None:
    cause = getattr(event, "cause", None)
    return cause.chain()[-1] if isinstance(cause, Cause) else None


def _path(event: Event) -> str:
    return str(getattr(event, "path", ""))


def _steps(events: Sequence[Event], steps: Mapping[int, NodeStep], path: str, since_seq: int) -> Iterator[LogLine]:
    """Yield how the containers around the origin ended after it, outermost first."""
    ends: dict[str, Event] = {}
    for event in events:
        step = steps.get(event.seq) if event.seq >= since_seq else None
        if step is not None and step.kind in ("ended", "diverted"):
            ends[step.path] = event
    parts = path.split("/") if path else []
    for depth in range(1, len(parts) + 1):
        node = "/".join(parts[:depth])
        if node in ends:
            yield log_line(ends[node])


def _entry(events: Sequence[Event], steps: Mapping[int, NodeStep], path: str, seq: int) -> Event:
    """Return the entry of the node's last visit before an event; the first event if it was never entered."""
    entries = (e for e in reversed(events) if e.seq <= seq and _path(e) == path and _is_entry(steps, e))
    return next(entries, events[0])


def _around(events: Sequence[Event], steps: Mapping[int, NodeStep], path: str, seq: int) -> tuple[LogLine, ...]:
    """Return the last log lines of the node's last visit, including its end."""
    begun = _entry(events, steps, path, seq)
    lines = [
        log_line(event, duration_s=event.time_s - begun.time_s)
        for event in events
        if event.seq >= begun.seq and _path(event) == path and event.__struct_config__.tag in _AROUND_KINDS
    ]
    return tuple(lines[-AROUND:])


def _link_and_hint(cause: Cause) -> tuple[CauseLine, str]:
    message, hint = _split_hint(cause.message) if cause.kind in _family(FlexcellError) else (cause.message, "")
    return msgspec.structs.replace(cause_line(cause), message=message), hint


def _family(kind: type[FlexcellError]) -> frozenset[str]:
    return frozenset({kind.__name__}.union(*(_family(each) for each in kind.__subclasses__())))


def _split_hint(message: str) -> tuple[str, str]:
    """Split the message of a flexcell error into message and hint, which is in parentheses at the end."""
    depth = 0
    for index in range(len(message) - 1, 0, -1):
        depth += {")": 1, "(": -1}.get(message[index], 0)
        if depth == 0:
            has_hint = index < len(message) - 1 and message[index - 1] == " "
            return (message[: index - 1], message[index + 1 : -1]) if has_hint else (message, "")
    return message, ""
