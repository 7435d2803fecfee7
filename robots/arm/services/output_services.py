"""Digital outputs of the robot's controller, by number and by connected device (RCL 4.3.9, tables 10 and 11)."""

from __future__ import annotations

from collections.abc import Mapping

from engine.bus import SkillBus, Topic
from engine.errors import RobotError
from engine.skills.digital_outputs import DigitalOutputs, SetGripper, SetLinearAxis, SetOutput, SetToolExchange
from engine.skills.switch_result import SwitchResult
from robots.port import ConfirmedOutputs, OutputPort


class OutputServices:
    """Implements `robots.port.SwitchableOutputs`.

    It serves SetOutput, and SetToolExchange, SetGripper and SetLinearAxis where an output has that use.

    Args:
        name: The arm's name on the bus.
        port: The outputs.
        uses: `tool_exchange`, `gripper` and `linear_axis` → the number of its output.
    """

    def __init__(self, name: str, port: OutputPort, *, uses: Mapping[str, int]) -> None:
        self._name = name
        self._port = port
        self._uses = uses
        self._topic: Topic[DigitalOutputs] | None = None

    def register(self, bus: SkillBus) -> None:
        """Advertise the services under the arm's name and publish `<arm>/digital_outputs`."""
        name, uses = self._name, self._uses
        self._topic = bus.topic(f"{name}/digital_outputs", DigitalOutputs)
        self._topic.provide(self._now)
        self._publish()
        bus.advertise_service(SetOutput, self._set_output, namespace=name, commands=name)
        if "tool_exchange" in uses:
            bus.advertise_service(SetToolExchange, self._set_tool_exchange, namespace=name, commands=name)
        if "gripper" in uses:
            bus.advertise_service(SetGripper, self._set_gripper, namespace=name, commands=name)
        if "linear_axis" in uses:
            bus.advertise_service(SetLinearAxis, self._set_linear_axis, namespace=name, commands=name)

    @property
    def values(self) -> tuple[bool, ...]:
        """Present values."""
        return self._port.values

    async def switch(self, output: int, *, on: bool) -> None:
        """Turn an output on or off, and return when the controller confirms it; raises RobotError."""
        self._port.set(output, on=on)
        if isinstance(self._port, ConfirmedOutputs):
            await self._port.confirmed()
        self._publish()

    async def _set_output(self, request: SetOutput) -> SwitchResult:
        if request.output is None:
            return SwitchResult(success=False, message=f"the outputs of {self._name} have numbers, not names")
        return await self._set(request.output, f"output {request.output}", value=request.value)

    async def _set_tool_exchange(self, request: SetToolExchange) -> SwitchResult:
        return await self._set_use("tool_exchange", value=request.value)

    async def _set_gripper(self, request: SetGripper) -> SwitchResult:
        return await self._set_use("gripper", value=request.value)

    async def _set_linear_axis(self, request: SetLinearAxis) -> SwitchResult:
        return await self._set_use("linear_axis", value=request.value)

    async def _set_use(self, use: str, *, value: bool) -> SwitchResult:
        output = self._uses[use]
        return await self._set(output, f"{use.replace('_', ' ')} (output {output})", value=value)

    async def _set(self, output: int, words: str, *, value: bool) -> SwitchResult:
        try:
            await self.switch(output, on=value)
        except RobotError as error:
            return SwitchResult(success=False, message=str(error))
        return SwitchResult(success=True, message=f"{words} is {'on' if value else 'off'}")

    def _publish(self) -> None:
        if self._topic is not None:
            self._topic.publish(self._now())

    def _now(self) -> DigitalOutputs:
        return DigitalOutputs(values=self._port.values)
