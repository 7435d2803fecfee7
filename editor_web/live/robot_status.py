"""Status of the cell's arms for the status bar of the page, from status, speed override and planned path."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from itertools import pairwise

import msgspec

from engine.messages.separation import SeparationState
from engine.project import Session
from engine.skill import activity_words
from engine.skills.arm_control import ArmStatus, SpeedOverride
from engine.skills.planning import PathPreview

# In this order: the status of an arm comes before its planned path.
_KINDS = (ArmStatus.__name__, SpeedOverride.__name__, PathPreview.__name__, SeparationState.__name__)


class PathLive(msgspec.Struct, frozen=True, kw_only=True):
    """The planned path of an arm: `proposed`, `moving` or `blocked`, the reason, and its start on the server's clock.

    `length_m` is the length of the tool's path.
    """

    state: str
    reason: str
    length_m: float
    since_s: float


class RobotLive(msgspec.Struct, frozen=True, kw_only=True):
    """One arm: its mode, its activity in words, the error of a reflex stop, and its speed override.

    `path` is its planned path, which the 3D view shows. `separation` says how separation monitoring slows it down,
    empty if it does not.
    """

    name: str
    mode: str
    activity: str
    error: str
    speed_override: float
    controller: str
    path: PathLive | None = None
    separation: str = ""


class RobotStatusCache:
    """Keeps the latest status of every arm.

    Args:
        backend: The engine.
        changed: Called with the name of an arm whose status has changed.
        unix_s: The server's clock.
    """

    def __init__(
        self, backend: Session, *, changed: Callable[[str], None], unix_s: Callable[[], float] = time.time
    ) -> None:
        self._backend = backend
        self._changed = changed
        self._unix_s = unix_s
        self._unsubscribe: list[Callable[[], None]] = []
        self.lines: dict[str, RobotLive] = {}

    async def open(self) -> None:
        """Subscribe to the topics of every arm on the bus."""
        entries = [each for each in await self._backend.bus.listing() if each.kind == "topic" and each.type in _KINDS]
        for entry in sorted(entries, key=lambda each: _KINDS.index(each.type)):
            self._follow(entry.name, entry.name.rpartition("/")[0])

    def close(self) -> None:
        """Unsubscribe from all topics."""
        for unsubscribe in self._unsubscribe:
            unsubscribe()
        self._unsubscribe = []

    def _follow(self, topic: str, arm: str) -> None:
        self._unsubscribe.append(self._backend.subscribe_topic(topic, lambda message: self._fold(arm, message)))

    def _fold(self, arm: str, message: object) -> None:
        known = self.lines.get(arm)
        match message:
            case ArmStatus():
                line = RobotLive(
                    name=arm,
                    mode=message.mode,
                    activity=activity_words(message.activity),
                    error=message.error,
                    speed_override=message.settings.speed_override,
                    controller=message.settings.controller,
                    path=known.path if known is not None else None,
                    separation=known.separation if known is not None else "",
                )
            case SpeedOverride() if known is not None:
                line = msgspec.structs.replace(known, speed_override=message.share)
            case SeparationState() if known is not None:
                line = msgspec.structs.replace(known, separation=_separation_words(message))
            case PathPreview() if known is not None:
                line = msgspec.structs.replace(known, path=self._path(known.path, message))
            case _:
                return
        if line != known:
            self.lines[arm] = line
            self._changed(arm)

    def _path(self, known: PathLive | None, preview: PathPreview) -> PathLive | None:
        if preview.state == "none":
            return None
        is_same_state = known is not None and known.state == preview.state
        return PathLive(
            state=preview.state,
            reason=preview.reason,
            length_m=sum(math.dist(start, end) for start, end in pairwise(preview.tool_path)),
            since_s=known.since_s if known is not None and is_same_state else self._unix_s(),
        )


def _separation_words(state: SeparationState) -> str:
    """Return how monitoring slows an arm down, in steps of 0.1 m; empty if it does not."""
    if not state.monitoring or state.permitted_share >= 1.0:
        return ""
    verb = "slowed down" if state.permitted_share > 0.0 else "stopped"
    if state.reason:
        return f"{verb}: {state.reason}"
    return f"{verb}: somebody at {state.distance_m:.1f} m" if state.distance_m is not None else ""
