"""Digital inputs of the robot's controller on the bus, with the names of the cell document."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from engine.bus import SkillBus, Topic
from engine.errors import RobotError
from engine.skills.digital_inputs import DigitalInputs, SimulateInput
from engine.skills.switch_result import SwitchResult
from robots.port import InputPort


class InputServices:
    """Publishes `<arm>/digital_inputs` whenever an input changes; simulated ones are set by `SimulateInput`.

    Args:
        name: The arm's name on the bus.
        port: The inputs.
        names: Names of the cell document → the number of the input.
        simulate: Sets a simulated input, `simulate(number, on=…)`; raises RobotError. None for real ones.
    """

    def __init__(
        self,
        name: str,
        port: InputPort,
        *,
        names: Mapping[str, int],
        simulate: Callable[..., None] | None = None,
    ) -> None:
        self._name = name
        self._port = port
        self._names = dict(names)
        self._simulate = simulate
        self._topic: Topic[DigitalInputs] | None = None
        self._published: DigitalInputs | None = None

    def register(self, bus: SkillBus) -> None:
        """Publish the inputs under the arm's name."""
        self._topic = bus.topic(f"{self._name}/digital_inputs", DigitalInputs)
        self._topic.provide(self.state)
        self._published = None
        self.publish_changes()
        if self._simulate is not None:
            bus.advertise_service(SimulateInput, self._set, namespace=self._name)

    def state(self) -> DigitalInputs:
        """Return the present values."""
        problem = self._port.problem
        values = () if problem else self._port.values[: self._port.count]
        return DigitalInputs(values=values, names=self._names, problem=problem)

    def publish_changes(self) -> None:
        """Publish the inputs if one has changed since."""
        state = self.state()
        if self._topic is not None and state != self._published:
            self._published = state
            self._topic.publish(state)

    async def _set(self, request: SimulateInput) -> SwitchResult:
        assert self._simulate is not None
        number = self._names.get(request.name) if request.input is None else request.input
        if number is None:
            known = ", ".join(self._names) or "none"
            return SwitchResult(success=False, message=f"there is no input {request.name}; the cell names {known}")
        try:
            self._simulate(number, on=request.value)
        except RobotError as error:
            return SwitchResult(success=False, message=str(error))
        self.publish_changes()
        return SwitchResult(success=True, message=f"input {number} is {'on' if request.value else 'off'}")
