"""Pins of equipment on the bus under their names: digital inputs, digital and PWM outputs, and what sets them."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable, Mapping
from dataclasses import dataclass

from engine.bus import SkillBus
from engine.errors import RobotError
from engine.skills.digital_inputs import DigitalInputs, SimulateInput
from engine.skills.digital_outputs import DigitalOutputs, SetOutput
from engine.skills.pwm_outputs import PwmOutputs, SetDutyCycle
from engine.skills.switch_result import SwitchResult
from robots.drivers.equipment.backends.pin_values import PinValue


@dataclass(frozen=True, kw_only=True)
class PinSignals:
    """What is known of the pins of one device."""

    inputs: DigitalInputs
    outputs: DigitalOutputs
    pwm: PwmOutputs

    @classmethod
    def of(
        cls, values: Mapping[str, bool | float], *, inputs: list[str], outputs: list[str], pwm: list[str]
    ) -> PinSignals:
        """Return the signals of these values; numbers are the places in the lists of names."""
        return cls(
            inputs=DigitalInputs(values=tuple(bool(values[name]) for name in inputs), names=_numbered(inputs)),
            outputs=DigitalOutputs(values=tuple(bool(values[name]) for name in outputs), names=_numbered(outputs)),
            pwm=PwmOutputs(duty_cycles={name: float(values[name]) for name in pwm}),
        )

    @classmethod
    def unknown(cls, problem: str) -> PinSignals:
        """Return that nothing is known, and why."""
        return cls(
            inputs=DigitalInputs(values=(), problem=problem),
            outputs=DigitalOutputs(values=(), problem=problem),
            pwm=PwmOutputs(duty_cycles={}, problem=problem),
        )


def _numbered(names: list[str]) -> dict[str, int]:
    return {name: number for number, name in enumerate(names)}


class EquipmentOutputs:
    """Implements `robots.port.SwitchableOutputs` and `NamedOutputs`: the digital outputs, for tools at them.

    Args:
        now: Returns what is known now.
        put: As that of `EquipmentSignals`.
    """

    def __init__(self, now: Callable[[], PinSignals], put: Callable[[str, PinValue], Awaitable[None]]) -> None:
        self._now = now
        self._put = put

    @property
    def values(self) -> tuple[bool, ...]:
        """Present values; none where nothing is known."""
        return self._now().outputs.values

    @property
    def names(self) -> Mapping[str, int]:
        """The present number of each by name."""
        return self._now().outputs.names

    async def switch(self, output: int, *, on: bool) -> None:
        """Turn one on or off and return when it is read back; raises RobotError."""
        await self._put(next(name for name, number in self.names.items() if number == output), on)


class EquipmentSignals:
    """Publishes `<name>/digital_inputs`, `…/digital_outputs` and `…/pwm_outputs`, and serves what sets outputs by name.

    Args:
        name: The namespace on the bus.
        now: Returns what is known now.
        put: `put(name, value)` sets an output, on or off or to a duty cycle, and returns when it is; raises RobotError.
        simulate: `simulate(name, on=…)` sets an input; None for real ones.
    """

    def __init__(
        self,
        name: str,
        now: Callable[[], PinSignals],
        put: Callable[[str, PinValue], Awaitable[None]],
        *,
        simulate: Callable[..., None] | None = None,
    ) -> None:
        self._name = name
        self._now = now
        self._put = put
        self._simulate = simulate
        self._bus: SkillBus | None = None
        self._published: PinSignals | None = None

    def register(self, bus: SkillBus) -> None:
        """Publish the pins under the name of the equipment and advertise its services."""
        self._bus = bus
        bus.topic(f"{self._name}/digital_inputs", DigitalInputs).provide(lambda: self._now().inputs)
        bus.topic(f"{self._name}/digital_outputs", DigitalOutputs).provide(lambda: self._now().outputs)
        bus.topic(f"{self._name}/pwm_outputs", PwmOutputs).provide(lambda: self._now().pwm)
        bus.advertise_service(SetOutput, self._set_output, namespace=self._name, commands=self._name)
        bus.advertise_service(SetDutyCycle, self._set_duty_cycle, namespace=self._name, commands=self._name)
        if self._simulate is not None:
            bus.advertise_service(SimulateInput, self._simulate_input, namespace=self._name)
        self._published = None
        self.publish_changes()

    def publish_changes(self) -> None:
        """Publish what has changed since the last time."""
        if self._bus is None:
            return
        now, before = self._now(), self._published
        self._published = now
        if before is None or now.inputs != before.inputs:
            self._bus.topic(f"{self._name}/digital_inputs", DigitalInputs).publish(now.inputs)
        if before is None or now.outputs != before.outputs:
            self._bus.topic(f"{self._name}/digital_outputs", DigitalOutputs).publish(now.outputs)
        if before is None or now.pwm != before.pwm:
            self._bus.topic(f"{self._name}/pwm_outputs", PwmOutputs).publish(now.pwm)

    async def _set_output(self, request: SetOutput) -> SwitchResult:
        known = self._now().outputs
        if known.problem:
            return SwitchResult(success=False, message=known.problem)
        if request.name not in known.names:
            # A number means another pin after a change of the configuration.
            what = request.name or f"number {request.output}"
            message = f"{self._name} has no output {what}; its outputs are {_listed(known.names)}"
            return SwitchResult(success=False, message=message)
        return await self._set(request.name, request.value, f"{request.name} is {'on' if request.value else 'off'}")

    async def _set_duty_cycle(self, request: SetDutyCycle) -> SwitchResult:
        known = self._now().pwm
        if known.problem:
            return SwitchResult(success=False, message=known.problem)
        if request.name not in known.duty_cycles:
            message = f"{self._name} has no PWM output {request.name}; those are {_listed(known.duty_cycles)}"
            return SwitchResult(success=False, message=message)
        return await self._set(request.name, request.duty_cycle, f"{request.name} is at {request.duty_cycle:.0%}")

    async def _set(self, name: str, value: PinValue, done: str) -> SwitchResult:
        try:
            await self._put(name, value)
        except RobotError as error:
            return SwitchResult(success=False, message=str(error))
        self.publish_changes()
        return SwitchResult(success=True, message=done)

    async def _simulate_input(self, request: SimulateInput) -> SwitchResult:
        assert self._simulate is not None
        names = self._now().inputs.names
        name = request.name or next((each for each, number in names.items() if number == request.input), "")
        if name not in names:
            what = request.name or request.input
            message = f"{self._name} has no input {what}; its inputs are {_listed(names)}"
            return SwitchResult(success=False, message=message)
        self._simulate(name, on=request.value)
        self.publish_changes()
        return SwitchResult(success=True, message=f"{name} is {'on' if request.value else 'off'}")


def _listed(names: Iterable[str]) -> str:
    return ", ".join(names) or "none"
