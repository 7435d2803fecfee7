"""Service answers of observations, for states that send the same requests in the following tick."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from engine.errors import FlexcellError
from engine.skill import Service


@dataclass(frozen=True)
class ObservedAnswer:
    """One request with its answer or error."""

    request: Service[Any]
    to: str
    answer: Any = None
    error: FlexcellError | None = None


class ObservedAnswers:
    """Observed answers of one run, by the path of the state."""

    def __init__(self) -> None:
        self._answers: dict[str, deque[ObservedAnswer]] = {}

    def keep(self, path: str, answers: Iterable[ObservedAnswer]) -> None:
        """Store the answers to the next requests of a state."""
        self._answers[path] = deque(answers)

    def take(self, path: str, request: Service[Any], to: str) -> ObservedAnswer | None:
        """Return the answer to the next request of a state; None where the request was not observed."""
        if not self._answers:
            return None
        known = self._answers.get(path)
        if not known or known[0].request != request or known[0].to != to:
            self.forget(path)
            return None
        return known.popleft()

    def forget(self, path: str) -> None:
        """Drop the stored answers of a state."""
        self._answers.pop(path, None)
