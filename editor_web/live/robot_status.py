"""The arms of the cell as the page's strip shows them, folded from status, speed override and planned path."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from itertools import pairwise

import msgspec

from editor_web.contracts.backend import Backend, Unsubscribe
from engine.skills.arm_control import ArmStatus, SpeedOverride
from engine.skills.planning import PathPreview

# In this order: what an arm is comes before what it plans.
_KINDS = (ArmStatus.__name__, SpeedOverride.__name__, PathPreview.__name__)


class PathLive(msgspec.Struct, frozen=True, kw_only=True):
    """The planned way of an arm: `proposed`, `moving` or `blocked`, by what, and since when (of the server's clock).

    `length_m` is that of the tool's path.
    """

    state: str
    reason: str
    length_m: float
    since_s: float


class RobotLive(msgspec.Struct, frozen=True, kw_only=True):
    """One arm: what it does, why it stopped by itself, and the share of their own speed that motions run at.

    `way` is the way that is planned for it, which the 3D view shows.
    """

    name: str
    mode: str
    activity: str
    error: str
    speed_override: float
    controller: str
    way: PathLive | None = None


class RobotStatusCache:
    """Keeps the newest line of every arm.

    Args:
        backend: Where the topics are.
        changed: Told the name of an arm whose line is another now.
        unix_s: The server's clock.
    """

    def __init__(
        self, backend: Backend, *, changed: Callable[[str], None], unix_s: Callable[[], float] = time.time
    ) -> None:
        self._backend = backend
        self._changed = changed
        self._unix_s = unix_s
        self._unsubscribe: list[Unsubscribe] = []
        self.lines: dict[str, RobotLive] = {}

    async def open(self) -> None:
        """Follow every arm that is on the bus now."""
        entries = [each for each in await self._backend.bus.listing() if each.kind == "topic" and each.type in _KINDS]
        for entry in sorted(entries, key=lambda each: _KINDS.index(each.type)):
            self._follow(entry.name, entry.name.rpartition("/")[0])

    def close(self) -> None:
        """Follow them no more."""
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
                    activity=message.activity,
                    error=message.error,
                    speed_override=message.settings.speed_override,
                    controller=message.settings.controller,
                    way=known.way if known is not None else None,
                )
            case SpeedOverride() if known is not None:
                line = msgspec.structs.replace(known, speed_override=message.share)
            case PathPreview() if known is not None:
                line = msgspec.structs.replace(known, way=self._way(known.way, message))
            case _:
                return
        if line != known:
            self.lines[arm] = line
            self._changed(arm)

    def _way(self, known: PathLive | None, preview: PathPreview) -> PathLive | None:
        if preview.state == "none":
            return None
        has_lasted = known is not None and known.state == preview.state
        return PathLive(
            state=preview.state,
            reason=preview.reason,
            length_m=sum(math.dist(here, there) for here, there in pairwise(preview.tool_path)),
            since_s=known.since_s if known is not None and has_lasted else self._unix_s(),
        )
