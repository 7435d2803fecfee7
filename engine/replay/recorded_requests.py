"""The requests of a recorded run, found by state path and number: the n-th request of a path, never a global order."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from engine.event import (
    GoalFinished,
    GoalHeld,
    GoalResumed,
    GoalSent,
    MessageReceived,
    NodeExited,
    PauseConfirmed,
    ServiceAnswered,
    ServiceCalled,
    UndoEnded,
)
from engine.recording import RecordedEvent


@dataclass(frozen=True)
class RecordedInstant:
    """Index of an event in the recording, from 0, and its time."""

    place: int
    at_s: float


@dataclass(kw_only=True)
class RecordedRequest:
    """A call or goal with its result; `end` is None if the recording does not contain it."""

    sent: ServiceCalled | GoalSent
    sent_s: float
    end: ServiceAnswered | GoalFinished | None = None
    ended: RecordedInstant | None = None
    held: list[RecordedInstant] = field(default_factory=list[RecordedInstant])
    resumed: list[RecordedInstant] = field(default_factory=list[RecordedInstant])
    cancelled: bool = False
    """Whether its state was cancelled before it had ended, even if only just before."""
    cannot_hold: str = ""
    """Why its device could not be held, if that was requested."""


@dataclass(frozen=True)
class RecordedRead:
    """A message that a state read from a topic."""

    event: MessageReceived
    moment: RecordedInstant


class RecordedRequests:
    """All requests of a recording; each is used once, in the order of its path."""

    def __init__(self, expected: Sequence[RecordedEvent]) -> None:
        self._requests: dict[str, list[RecordedRequest]] = defaultdict(list)
        self._reads: dict[tuple[str, str], deque[RecordedRead]] = defaultdict(deque)
        self._taken: dict[str, int] = defaultdict(int)
        self._index(expected)

    def take(self, path: str) -> RecordedRequest | None:
        """Return the next request of a path; None if the recording has no more."""
        known = self._requests.get(path, ())
        number = self._taken[path]
        self._taken[path] += 1
        return known[number] if number < len(known) else None

    def take_read(self, path: str, topic: str) -> RecordedRead | None:
        """Return the next message that a path read from a topic; None if the recording has no more."""
        due = self._reads.get((path, topic))
        return due.popleft() if due else None

    def give_back(self, read: RecordedRead) -> None:
        """Return a message to the queue of the next read: a cancelled read is not in the recording."""
        self._reads[read.event.path, read.event.topic].appendleft(read)

    def _index(self, expected: Iterable[RecordedEvent]) -> None:
        open_requests: dict[str, RecordedRequest] = {}
        ended: dict[str, RecordedRequest] = {}
        for place, each in enumerate(expected):
            moment = RecordedInstant(place, each.at_s)
            match each.event:
                case ServiceCalled() as event:
                    open_requests[event.call] = self._add(event, each.at_s)
                case GoalSent() as event:
                    open_requests[event.goal] = self._add(event, each.at_s)
                case ServiceAnswered(call=name) | GoalFinished(goal=name) as event:
                    if (request := open_requests.get(name)) is not None:
                        request.end, request.ended = event, moment
                        request.cancelled = isinstance(event, GoalFinished) and event.status == "canceled"
                        ended[event.path] = request
                case NodeExited(path=path, preempted=True) | UndoEnded(path=path, preempted=True):
                    request = ended.pop(path, None)
                    if request is not None and request.ended is not None and each.at_s == request.ended.at_s:
                        request.cancelled = True
                case GoalHeld(goal=name):
                    if (request := open_requests.get(name)) is not None:
                        request.held.append(moment)
                case GoalResumed(goal=name):
                    if (request := open_requests.get(name)) is not None:
                        request.resumed.append(moment)
                case PauseConfirmed(cannot=lines):
                    for line in lines:
                        name, _, why = line.partition(": ")
                        if (request := open_requests.get(name)) is not None:
                            request.cannot_hold = why
                case MessageReceived() as event:
                    self._reads[event.path, event.topic].append(RecordedRead(event, moment))
                case _:
                    pass

    def _add(self, event: ServiceCalled | GoalSent, at_s: float) -> RecordedRequest:
        request = RecordedRequest(sent=event, sent_s=at_s)
        self._requests[event.path].append(request)
        return request
