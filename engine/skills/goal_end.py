"""The status of a goal and its end, as clients of the bus and states see them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Generic, TypeVar

from engine.errors import Cause

R = TypeVar("R")


class GoalStatus(StrEnum):
    """The status of a goal; the last four are final."""

    PENDING = "pending"
    ACTIVE = "active"
    HELD = "held"
    CANCELING = "canceling"
    SUCCEEDED = "succeeded"
    CANCELED = "canceled"
    ABORTED = "aborted"
    REJECTED = "rejected"


@dataclass(frozen=True)
class GoalEnd(Generic[R]):
    """The end of a goal; `result` may be partial unless it succeeded, `cause` is the reason of a failure."""

    status: GoalStatus
    result: R | None
    cause: Cause | None
