"""Equipment whose pins are in memory, for `driver: sim`: the entry point `equipment` of `flexcell.worlds`."""

from __future__ import annotations

from types import TracebackType
from typing import Self

from engine.bus import SkillBus
from engine.document.equipment import DigitalInputPin, EquipmentDocument
from engine.robot import DeviceStatus
from robots.drivers.equipment.backends.pin_values import PinValue
from robots.drivers.equipment.device.equipment_signals import EquipmentOutputs, EquipmentSignals, PinSignals


class SimulatedEquipment:
    """Implements `engine.robot.Robot`. Outputs begin with their safe values, inputs are off until they are simulated.

    Args:
        document: Its pins.
        name: Its bus namespace.
    """

    def __init__(self, document: EquipmentDocument, *, name: str) -> None:
        self._document = document
        self._name = name
        self._open = False
        self._values: dict[str, bool | float] = {}
        self._signals = EquipmentSignals(name, self._now, self._put, simulate=self._simulate)

    @property
    def name(self) -> str:
        """The bus namespace of its skills."""
        return self._name

    @property
    def outputs(self) -> EquipmentOutputs | None:
        """Its digital outputs, for tools at them; None while it is not connected."""
        return EquipmentOutputs(self._now, self._put) if self._open else None

    @property
    def status(self) -> DeviceStatus:
        """READY while it is open."""
        return DeviceStatus.READY if self._open else DeviceStatus.DISCONNECTED

    def register(self, bus: SkillBus) -> None:
        """Publish its pins and advertise the services that set outputs and simulate inputs."""
        self._signals.register(bus)

    async def stop(self) -> None:
        """Do what STOP does at the pins: outputs with `at_stop: safe` get their safe values."""
        self._values.update(self._document.stop_values)
        self._signals.publish_changes()

    async def __aenter__(self) -> Self:
        inputs = {name: False for name, pin in self._document.pins.items() if isinstance(pin, DigitalInputPin)}
        self._values = {**inputs, **self._document.safe_values}
        self._open = True
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._open = False

    def _now(self) -> PinSignals:
        document = self._document
        return PinSignals.of(
            self._values, inputs=list(document.inputs), outputs=list(document.outputs), pwm=list(document.pwm_outputs)
        )

    async def _put(self, output: str, value: PinValue) -> None:
        self._values[output] = value

    def _simulate(self, name: str, *, on: bool) -> None:
        self._values[name] = on
