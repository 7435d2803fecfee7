"""A switched tool at outputs that note what is set, with its skills on a bus."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from types import TracebackType
from typing import Any, Self, cast

import msgspec

from engine.bus import SkillBus
from engine.cell.drivers import DeviceReport, installed_driver
from engine.clock import new_clock
from engine.errors import RobotError
from engine.messages.topic_value import TopicValue
from engine.robot import DeviceStatus
from engine.skills.devices import EnableDevice
from robots.drivers.switched_tool.switched_tool import SwitchedTool
from robots.sim.grip.tool_summary import ToolSummary
from robots.switched.switched_kind import SwitchedKind
from robots.switched.switched_options import SwitchedToolOptions
from robots.tool_kinds import load_switched

ARM = "left"
SENSOR = "line/part_sensor"
OUTPUTS = 4


class SwitchBox:
    """Implements `Robot`, `Reconnectable` and `OutputOwner`: a device with outputs and nothing else.

    Attributes:
        switched: What was set, in order.
        values: Present values.
        lost_reason: Why its connection is lost.
        refusal: Why it sets nothing; empty if it does.
    """

    name = ARM
    status = DeviceStatus.READY

    def __init__(self) -> None:
        self.switched: list[tuple[int, bool]] = []
        self.values: tuple[bool, ...] = (False,) * OUTPUTS
        self.lost_reason = ""
        self.refusal = ""

    @property
    def outputs(self) -> SwitchBox:
        """Itself."""
        return self

    async def switch(self, output: int, *, on: bool) -> None:
        """Set an output."""
        if self.refusal:
            raise RobotError(self.refusal, where=self.name)
        self.switched.append((output, on))
        self.values = (*self.values[:output], on, *self.values[output + 1 :])

    def when_connection_changes(self, callback: object) -> None:
        """Tell nobody."""

    async def reconnect(self) -> str:
        """Be there again."""
        self.lost_reason = ""
        return ""

    def register(self, bus: SkillBus) -> None:
        """Serve nothing."""

    async def stop(self) -> None:
        """Rest."""

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close."""


@asynccontextmanager
async def switched(
    kind: str, *, enable: bool = True, box: SwitchBox | None = None, **options: Any
) -> AsyncGenerator[tuple[SkillBus, SwitchedTool, SwitchBox]]:
    """A tool of a kind with a range of 85 mm and a force of 200 N."""
    box = box or SwitchBox()
    driver = installed_driver(f"switched_{kind}")
    chosen = cast("SwitchedToolOptions", msgspec.convert({"kind": driver.kind, **options}, driver.options))
    name = f"{ARM}/{kind}"
    device = SwitchedTool(
        name,
        chosen,
        kind=cast("SwitchedKind", load_switched(kind)),
        tool=ToolSummary(kind=kind, contacts=2, max_width_m=0.085, max_force_n=200.0),
        owner=ARM,
        devices={ARM: box},
        about=DeviceReport(device=name, driver=driver.kind, address=f"{ARM}, output 0"),
    )
    async with SkillBus(new_clock()) as bus, device:
        bus.topic(SENSOR, TopicValue)
        device.register(bus)
        if enable:
            await bus.call(EnableDevice(reason="a test"), to=name)
        yield bus, device, box


def detect(bus: SkillBus, *, part: bool) -> None:
    """Let the sensor say whether there is a part."""
    bus.topic(SENSOR, TopicValue).publish(TopicValue(value=part))
