"""A context whose skills answer as a script says, and that remembers what a state asked."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeVar, cast

import msgspec

from engine.clock import LoopClock
from engine.errors import Cause, NoSuchSkill
from engine.skill import Action, Service
from engine.skills.goal_end import GoalEnd, GoalStatus

R = TypeVar("R")
F = TypeVar("F")
S = TypeVar("S", bound=msgspec.Struct)


def broken_off(status: GoalStatus, cause: Cause | None) -> GoalEnd[object]:
    """Make the end of a goal that gave no result."""
    return GoalEnd(status, None, cause)


class FakeContext:
    """Answers by bus address.

    Args:
        answers: Address → the answer of a service (an exception is raised) or the `GoalEnd` of a goal; of a
            list, the first one left.
        topics: Topic → its latest message.
    """

    def __init__(
        self, answers: Mapping[str, object] | None = None, *, topics: Mapping[str, msgspec.Struct] | None = None
    ) -> None:
        self.answers = dict(answers or {})
        self._topics = dict(topics or {})
        self.clock = LoopClock()
        self.path = "root/step"
        self.sent: list[tuple[str, object]] = []
        self.logged: list[tuple[str, str]] = []

    async def call(self, request: Service[R], *, to: str) -> R:
        """Give the scripted answer."""
        return self._answer(request, to)

    async def perform(self, goal: Action[R, F], *, to: str) -> GoalEnd[R]:
        """Give the scripted end."""
        return self._answer(goal, to)

    async def latest(self, topic: str, kind: type[S]) -> S:
        """Give the scripted message."""
        message = self._topics[topic]
        assert isinstance(message, kind)
        return message

    async def next_message(self, topic: str, kind: type[S]) -> S:
        """Give the scripted message."""
        return await self.latest(topic, kind)

    async def latest_data(self, topic: str) -> object:
        """Give the scripted message."""
        return msgspec.to_builtins(self._topics[topic])

    async def next_data(self, topic: str, condition: Callable[[object], bool]) -> object:
        """Give the scripted message."""
        message = await self.latest_data(topic)
        assert condition(message)
        return message

    async def publish(self, topic: str, message: object) -> None:
        """Remember the message."""
        self.sent.append((topic, message))

    async def offer(self, outcome: str) -> None:
        """Agree at once."""

    def log(self, message: str, *, level: str = "info") -> None:
        """Remember the line."""
        self.logged.append((level, message))

    def random(self) -> float:
        """Be the least random of all."""
        return 0.5

    def _answer(self, request: Any, to: str) -> Any:
        address = request.address(to)
        self.sent.append((address, request))
        if address not in self.answers:
            raise NoSuchSkill("no such service", where=address)
        answer: Any = self.answers[address]
        if isinstance(answer, list):
            answer = cast("list[Any]", answer).pop(0)
        if isinstance(answer, Exception):
            raise answer
        return answer
