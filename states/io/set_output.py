"""io.SetOutput: turns a digital output of a robot's controller or of equipment on or off."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from msgspec import Meta

from engine.skill import Service
from engine.skills import digital_outputs as outputs
from engine.skills.digital_outputs import On, OutputNumber, SetGripper, SetLinearAxis, SetToolExchange
from engine.state import Context, Outcome, Skills, State
from states.call_or_fail import call_or_fail

OutputUse = Literal["tool_exchange", "gripper", "linear_axis"]


class SetOutput(State, frozen=True, kw_only=True):
    """Turn an output on or off, by its number (`output`) or by the device connected to it (`device`).

    Outputs of equipment have names (`name`) instead.
    """

    state_name: ClassVar[str] = "io.SetOutput"
    skills: ClassVar[Skills] = (outputs.SetOutput, SetToolExchange, SetGripper, SetLinearAxis)
    outcomes: ClassVar[tuple[str, ...]] = ("set", "failed")
    success: ClassVar[tuple[str, ...]] = ("set",)

    robot: Annotated[
        str,
        Meta(
            min_length=1,
            description="The robot whose controller has the output, or the equipment",
            extra_json_schema={"cell_name": "controller"},
        ),
    ]
    value: On
    output: Annotated[OutputNumber, Meta(extra_json_schema={"cell_name": "output", "of": "robot"})] | None = None
    device: Annotated[
        OutputUse | None,
        Meta(
            description="Device that the cell connects to one of the outputs",
            extra_json_schema={"cell_name": "output", "of": "robot"},
        ),
    ] = None
    name: (
        Annotated[
            str,
            Meta(
                min_length=1,
                description="Name of a pin of the equipment",
                extra_json_schema={"cell_name": "output", "of": "robot"},
            ),
        ]
        | None
    ) = None

    def __post_init__(self) -> None:
        if sum(each is not None for each in (self.output, self.device, self.name)) != 1:
            raise ValueError("give one of `output`, `device` and `name`")

    def resources(self) -> tuple[str, ...]:
        """Return the robot or equipment."""
        return (self.robot,)

    async def run(self, ctx: Context) -> Outcome:
        """Call the service of the robot or equipment."""
        name = self.name or self.device or f"output {self.output}"
        what = f"{name} of {self.robot} was not turned {'on' if self.value else 'off'}"
        return await call_or_fail(ctx, self._request(), to=self.robot, done="set", what=what, kind=self.state_name)

    def _request(self) -> Service[Any]:
        match self.device:
            case "tool_exchange":
                return SetToolExchange(value=self.value)
            case "gripper":
                return SetGripper(value=self.value)
            case "linear_axis":
                return SetLinearAxis(value=self.value)
            case None:
                return outputs.SetOutput(output=self.output, name=self.name or "", value=self.value)
