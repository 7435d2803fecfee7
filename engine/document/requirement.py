"""What a sweep requires: a success rate, or the share of runs in which a number keeps a limit.

    success >= 0.98
    share(cell.contact_force_max_n <= 30) >= 0.95

A largest value of all runs cannot be required: no number of runs proves that a value never occurs. The share of runs
that keep a limit can be proven, and `share(X <= 30) >= 0.95` says that the 95 % quantile of X is at most 30.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Literal, Self

from msgspec import Meta

from engine.errors import DocumentError

_NUMBER = r"-?\d+(\.\d+)?([eE][-+]?\d+)?"
_RATE = r"(0(\.\d+)?|1(\.0+)?)"
_FORM = rf"^ *(success|share\( *[^\s<>=()]+ *(<=|>=) *{_NUMBER} *\)) *>= *{_RATE} *$"
_SHARE = re.compile(r"share\((?P<name>[^<>]+)(?P<side><=|>=)(?P<limit>[^)]+)\)")
_FORMS = "`success >= 0.98` or `share(cell.contact_force_max_n <= 30) >= 0.95`"
# The form is checked where the text is parsed: msgspec frees a pattern twice that stands beside a list in a union.
RequirementText = Annotated[str, Meta(description=_FORMS, extra_json_schema={"pattern": _FORM})]


@dataclass(frozen=True, kw_only=True)
class NumberLimit:
    """A limit that a number of a run keeps, including the limit itself."""

    name: str
    """A measure, userdata at the end, or `duration_s`."""
    side: Literal["<=", ">="]
    limit: float

    def is_kept(self, numbers: Mapping[str, float]) -> bool:
        """Return whether a run with these numbers keeps it; one without the number does not show that it does."""
        value = numbers.get(self.name)
        if value is None:
            return False
        return value <= self.limit if self.side == "<=" else value >= self.limit


@dataclass(frozen=True, kw_only=True)
class Requirement:
    """A share of runs that is required."""

    text: str
    """As it is written, with single spaces."""
    rate: float
    limit: NumberLimit | None
    """What these runs keep; None where they succeed."""

    @classmethod
    def parse(cls, text: str, *, where: object = None) -> Self:
        """Return the requirement that a text says.

        Raises:
            DocumentError: it says none; at `where`.
        """
        if not re.match(_FORM, text):
            raise DocumentError(f"`require`: {text!r} is no requirement", where=where, hint=_FORMS)
        kept, _, rate = text.rpartition(">=")
        found = _SHARE.search(kept)
        if found is None:
            return cls(text=f"success >= {rate.strip()}", rate=float(rate), limit=None)
        name, limit = found["name"].strip(), found["limit"].strip()
        side: Literal["<=", ">="] = "<=" if found["side"] == "<=" else ">="
        return cls(
            text=f"share({name} {side} {limit}) >= {rate.strip()}",
            rate=float(rate),
            limit=NumberLimit(name=name, side=side, limit=float(limit)),
        )

    def is_kept(self, *, success: bool, numbers: Mapping[str, float]) -> bool:
        """Return whether a run that ended so keeps it."""
        return success if self.limit is None else self.limit.is_kept(numbers)
