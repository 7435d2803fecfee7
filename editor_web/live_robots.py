"""The arms of the cell as the page's strip shows them, folded from `<arm>/status` and `<arm>/speed_override`."""

from __future__ import annotations

from collections.abc import Callable

import msgspec

from editor_web.backend import Backend, Unsubscribe
from engine.skills.arm_control import ArmStatus, SpeedOverride

_STATUS, _SPEED = "/status", "/speed_override"


class RobotLine(msgspec.Struct, frozen=True, kw_only=True):
    """One arm: what it does, why it stopped by itself, and the share of their own speed that motions run at."""

    name: str
    mode: str
    activity: str
    error: str
    speed_override: float
    controller: str


class RobotBoard:
    """Keeps the newest line of every arm.

    Args:
        backend: Where the topics are.
        changed: Told the name of an arm whose line is another now.
    """

    def __init__(self, backend: Backend, *, changed: Callable[[str], None]) -> None:
        self._backend = backend
        self._changed = changed
        self._unsubscribe: list[Unsubscribe] = []
        self.lines: dict[str, RobotLine] = {}

    async def open(self) -> None:
        """Follow every arm that is on the bus now."""
        for entry in await self._backend.bus.listing():
            if entry.kind != "topic":
                continue
            if entry.type == ArmStatus.__name__ and entry.name.endswith(_STATUS):
                self._follow(entry.name, entry.name.removesuffix(_STATUS))
            elif entry.type == SpeedOverride.__name__ and entry.name.endswith(_SPEED):
                self._follow(entry.name, entry.name.removesuffix(_SPEED))

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
                line = RobotLine(
                    name=arm,
                    mode=message.mode,
                    activity=message.activity,
                    error=message.error,
                    speed_override=message.settings.speed_override,
                    controller=message.settings.controller,
                )
            case SpeedOverride() if known is not None:
                line = msgspec.structs.replace(known, speed_override=message.share)
            case _:
                return
        if line != known:
            self.lines[arm] = line
            self._changed(arm)
