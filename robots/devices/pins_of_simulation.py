"""Devices on equipment in a simulated world: axes follow the outputs of pins, simulated inputs follow the sensors."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from contextlib import suppress
from typing import Protocol

from engine.bus import SkillBus
from engine.clock import Clock
from engine.errors import RobotError
from engine.skills.digital_inputs import SimulateInput
from engine.skills.digital_outputs import DigitalOutputs, SetOutput
from robots.devices.device_sequence import POLL_S


class DeviceOnPins(Protocol):
    """A simulated device whose outputs and sensors are pins of equipment."""

    outputs: dict[str, bool]

    @property
    def sensors(self) -> Mapping[str, bool]:
        """What the sensors say; raises RobotError while the device is not in the cell."""
        ...

    def take_outputs(self, values: Mapping[str, bool]) -> None:
        """Have outputs from the next step on."""
        ...


class PinFollower:
    """Connects devices with the pins of one piece of equipment, on the event loop, every 20 ms.

    Real equipment has inputs of its own: a device in the world is its picture then.

    Args:
        equipment: Its name.
        devices: The devices on it.
        simulated: Whether its pins are in memory.
        clock: The time.
    """

    def __init__(self, equipment: str, devices: tuple[DeviceOnPins, ...], *, simulated: bool, clock: Clock) -> None:
        self._equipment = equipment
        self._devices = devices
        self._simulated = simulated
        self._clock = clock
        self._known_inputs: dict[str, bool] = {}
        self._kept: dict[str, bool] = {}
        self._task: asyncio.Task[None] | None = None

    def start(self, bus: SkillBus) -> None:
        """Begin to follow; the equipment may be opened later."""
        self._task = asyncio.create_task(self._follow(bus), name=f"devices on {self._equipment}")

    def keep(self) -> None:
        """Have simulated outputs as the devices have them now: those of a snapshot, so that what is held stays held."""
        if self._simulated:
            self._kept = {name: on for device in self._devices for name, on in device.outputs.items()}

    async def close(self) -> None:
        """End."""
        task, self._task = self._task, None
        if task is not None:
            task.cancel()
            await asyncio.wait([task])

    async def _follow(self, bus: SkillBus) -> None:
        outputs = bus.topic(f"{self._equipment}/digital_outputs", DigitalOutputs)
        while True:
            known = outputs.latest
            if known is not None and not known.problem:
                await self._set_kept(bus)
                self._take(outputs.latest or known)
                await self._set_inputs(bus)
            await self._clock.sleep(POLL_S)

    def _take(self, known: DigitalOutputs) -> None:
        values = {name: known.values[number] for name, number in known.names.items()}
        for device in self._devices:
            if any(values.get(name, on) != on for name, on in device.outputs.items()):
                device.take_outputs(values)

    async def _set_kept(self, bus: SkillBus) -> None:
        kept, self._kept = self._kept, {}
        for name, on in kept.items():
            await bus.call(SetOutput(name=name, value=on), to=self._equipment)

    async def _set_inputs(self, bus: SkillBus) -> None:
        if not self._simulated:
            return
        for device in self._devices:
            sensors: Mapping[str, bool] = {}
            with suppress(RobotError):  # it is not in the cell, or the world is lost: its inputs stay as they are
                sensors = device.sensors
            for name, on in sensors.items():
                if self._known_inputs.get(name) != on:
                    await bus.call(SimulateInput(name=name, value=on), to=self._equipment)
                    self._known_inputs[name] = on
