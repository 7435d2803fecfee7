"""Devices whose outputs and sensors are pins of equipment: the entry point `devices` of `flexcell.worlds`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import TracebackType
from typing import Self

from engine.bus import Holder, SkillBus
from engine.document import Cell, DeviceSpec
from engine.errors import RobotError
from engine.robot import DeviceStatus
from engine.skills.digital_inputs import DigitalInputs
from engine.skills.digital_outputs import DigitalOutputs, SetOutput
from robots.devices.device_server import DeviceServer, known_at


class PinPort:
    """Implements `DevicePort` over the topics and services of equipment, simulated or real.

    Args:
        device: The device.
        equipment: The name of the equipment.
        bus: Where it is.
    """

    def __init__(self, device: DeviceSpec, equipment: str, bus: SkillBus) -> None:
        self._device = device
        self._equipment = equipment
        self._bus = bus
        self._inputs = bus.topic(f"{equipment}/digital_inputs", DigitalInputs)
        self._outputs = bus.topic(f"{equipment}/digital_outputs", DigitalOutputs)

    async def set_output(self, name: str, *, on: bool, holder: Holder) -> None:
        """Have the equipment set the output, and return when it has read it back.

        Raises:
            RobotError: it is not enabled, does not answer, or reads something else.
            LeaseRefused: another run commands the equipment.
        """
        done = await self._bus.call(SetOutput(name=name, value=on), to=self._equipment, holder=holder)
        if not done.success:
            raise RobotError(f"the output {name} was not set: {done.message}", where=self._equipment)

    @property
    def outputs(self) -> Mapping[str, bool]:
        """What is read back of the outputs of the device; raises RobotError where it is not known."""
        return self._values(self._device.outputs, self._outputs.latest)

    @property
    def sensors(self) -> Mapping[str, bool]:
        """The inputs that are sensors of the device; raises RobotError where they are not known."""
        return self._values(self._device.sensors, self._inputs.latest)

    @property
    def axes(self) -> Mapping[str, float]:
        """None: pins measure no places."""
        return {}

    def _values(self, names: Iterable[str], known: DigitalInputs | DigitalOutputs | None) -> dict[str, bool]:
        if known is None or known.problem:
            raise RobotError(known.problem if known is not None else "its pins are not known", where=self._equipment)
        for name in names:
            if name not in known.names:
                raise RobotError(f"there is no pin {name}", where=self._equipment, hint="see `flexcell devices`")
        return {name: known.values[known.names[name]] for name in names}


class EquippedDevices:
    """Serves these devices while the cell is open; implements `engine.robot.Robot`.

    A stop ends their sequences; what outputs do then is up to the equipment.
    """

    name = "cell/equipped_devices"

    def __init__(self, cell: Cell, *, bus: SkillBus) -> None:
        self._devices = cell.document.devices
        self._bus = bus
        self._servers = tuple(
            DeviceServer(name, device, PinPort(device, device.equipment, bus), clock=bus.clock, is_at=self._is_at)
            for name, device in self._devices.items()
            if device.equipment is not None
        )
        self.status = DeviceStatus.DISCONNECTED

    def register(self, bus: SkillBus) -> None:
        """Advertise the skills of each device."""
        for server in self._servers:
            server.register(bus)

    async def stop(self) -> None:
        """End all sequences."""
        for server in self._servers:
            await server.stop()

    async def __aenter__(self) -> Self:
        self.status = DeviceStatus.READY
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.stop()
        self.status = DeviceStatus.DISCONNECTED

    def _is_at(self, device: str, position: str) -> bool:
        """Return whether a device of the cell, on equipment or simulated, is at a position."""
        return known_at(self._bus, device, self._devices[device], position)
