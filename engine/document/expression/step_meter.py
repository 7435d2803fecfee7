"""Counts the steps of expressions, so that many cheap ones in a row are limited too.

Each thread has its own count. It counts the bounds known before an evaluation, not clock time, so that
two runs of one behavior have the same count.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Generator
from contextlib import contextmanager

from engine.errors import ExpressionError


class StepMeter(threading.local):
    """The steps of this thread so far, and its remaining budget."""

    spent: float = 0.0
    """Steps of expressions."""
    worked: float = 0.0
    """Steps of expressions and of their overhead: copying and measuring values."""
    _limit: float = math.inf
    _subject: str = ""

    def spend(self, steps: float) -> None:
        """Count an evaluation that is about to begin.

        Raises:
            ExpressionError: the limit of `limited` is exceeded.
        """
        self.spent += steps
        self.worked += steps
        if self.spent > self._limit:
            message = f"the expressions of {self._subject} take too many steps together"
            raise ExpressionError(message, hint="use fewer or simpler expressions, or a state")

    def work(self, steps: float) -> None:
        """Count overhead of an expression; it counts for the event loop, not against a limit."""
        self.worked += steps

    @contextmanager
    def limited(self, steps: float, subject: str) -> Generator[None]:
        """Limit the steps inside the context; `subject` names their origin in the message."""
        outer = self._limit, self._subject
        self._limit, self._subject = min(self._limit, self.spent + steps), subject
        try:
            yield
        finally:
            self._limit, self._subject = outer


METER = StepMeter()
"""The meter of all evaluations."""
