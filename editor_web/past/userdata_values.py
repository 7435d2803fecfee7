"""The userdata of a run at any point in time, reduced as in the live view, with checkpoints."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence

import msgspec

from editor_web.past.state_history import RunStateHistory
from editor_web.telemetry.page_subscriptions import userdata_scope, watch_values
from engine.runtime.history import ScopeView, UserdataHistory, Watch, WatchValue

_EVERY = 1024
"""Events between two checkpoints."""


class PastUserdata(msgspec.Struct, frozen=True, kw_only=True):
    """The scopes of a run after event `seq`, by container path, and the values of the watches, in their order.

    `problem` tells why there are none.
    """

    seq: int
    scopes: dict[str, ScopeView]
    watches: tuple[WatchValue, ...] = ()
    problem: str = ""


class UserdataCheckpoints:
    """The userdata of one run. Not thread-safe.

    Args:
        checkpoint: The userdata history of the run before its first event; None if the executed behavior is unknown.
    """

    def __init__(self, checkpoint: UserdataHistory | None) -> None:
        self._checkpoints = [checkpoint] if checkpoint is not None else []

    def at(self, states: RunStateHistory, seq: int, *, watches: Sequence[Watch] = ()) -> PastUserdata:
        """Return the values after event `seq` of the run with this state history."""
        if not self._checkpoints:
            return PastUserdata(seq=seq, scopes={}, problem="the executed behavior is unknown")
        index = bisect_right(self._checkpoints, seq, key=lambda checkpoint: checkpoint.seq) - 1
        checkpoint = self._checkpoints[index].copy()
        while checkpoint.seq + _EVERY < seq:
            checkpoint.read(states.events(checkpoint.seq + 1, checkpoint.seq + _EVERY))
            if checkpoint.seq > self._checkpoints[-1].seq:
                self._checkpoints.append(checkpoint.copy())
        checkpoint.read(states.events(checkpoint.seq + 1, seq))
        return PastUserdata(
            seq=seq,
            scopes={path: userdata_scope(scope) for path, scope in checkpoint.scopes.items()},
            watches=watch_values(watches, checkpoint),
        )
