"""Counts the steps that expressions take, so that many cheap ones in a row are noticed too.

Each thread counts for itself. Counting is by bounds that are known before the evaluation, never by
the clock, so that two runs of one behavior count alike.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Generator
from contextlib import contextmanager

from engine.errors import ExpressionError


class StepMeter(threading.local):
    """The steps of this thread so far, and how many more it may take."""

    spent: float = 0.0
    """Steps of expressions."""
    worked: float = 0.0
    """Those, and what is done for them: values are copied and measured."""
    _limit: float = math.inf
    _subject: str = ""

    def spend(self, steps: float) -> None:
        """Count an evaluation that is about to begin.

        Raises:
            ExpressionError: it is one too many inside `limited`.
        """
        self.spent += steps
        self.worked += steps
        if self.spent > self._limit:
            message = f"the expressions of {self._subject} take too many steps together"
            raise ExpressionError(message, hint="use fewer or simpler expressions, or a state")

    def work(self, steps: float) -> None:
        """Count what is done for an expression; it counts for the loop, not against a limit."""
        self.worked += steps

    @contextmanager
    def limited(self, steps: float, subject: str) -> Generator[None]:
        """Let at most so many steps be taken inside; `subject` names in the message what takes them."""
        outer = self._limit, self._subject
        self._limit, self._subject = min(self._limit, self.spent + steps), subject
        try:
            yield
        finally:
            self._limit, self._subject = outer


METER = StepMeter()
"""What every evaluation is counted on."""
