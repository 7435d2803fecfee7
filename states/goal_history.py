"""Goals of an activation with their results, which hold the start state of the device that an undo restores."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeVar

import msgspec

from engine.runtime import decode_nonfinite
from engine.skill import Action
from engine.state import ActivationRecord, RequestRecord

R = TypeVar("R")


def accepted_goals(done: ActivationRecord, goal: type[Action[R, Any]]) -> Sequence[tuple[RequestRecord, R | None]]:
    """Return the accepted goals of one kind, newest first, each with its result; None if the result is unknown."""
    name = f"/{goal.skill_name()}"
    sent = (each for each in reversed(done.requests) if each.address.endswith(name) and each.status != "rejected")
    return [(each, _result(each, goal)) for each in sent]


def _result(request: RequestRecord, goal: type[Action[R, Any]]) -> R | None:
    if request.result is None:
        return None
    return msgspec.convert(decode_nonfinite(request.result), goal.result_type())
