"""io.SetDutyCycle: sets the duty cycle of a PWM output of equipment."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.skills import pwm_outputs
from engine.skills.pwm_outputs import DutyCycle
from engine.state import Context, Outcome, Skills, State
from states.call_or_fail import call_or_fail


class SetDutyCycle(State, frozen=True, kw_only=True):
    """Set the duty cycle of a PWM output: the brightness of a lamp, the speed of a fan, the position of a servo."""

    state_name: ClassVar[str] = "io.SetDutyCycle"
    skills: ClassVar[Skills] = (pwm_outputs.SetDutyCycle,)
    outcomes: ClassVar[tuple[str, ...]] = ("set", "failed")
    success: ClassVar[tuple[str, ...]] = ("set",)

    equipment: Annotated[
        str,
        Meta(min_length=1, description="The equipment with the output", extra_json_schema={"cell_name": "equipment"}),
    ]
    name: Annotated[
        str,
        Meta(
            min_length=1,
            description="Name of a PWM output of the equipment",
            extra_json_schema={"cell_name": "pwm_output", "of": "equipment"},
        ),
    ]
    duty_cycle: DutyCycle

    def resources(self) -> tuple[str, ...]:
        """Return the equipment."""
        return (self.equipment,)

    async def run(self, ctx: Context) -> Outcome:
        """Call the service of the equipment."""
        request = pwm_outputs.SetDutyCycle(name=self.name, duty_cycle=self.duty_cycle)
        what = f"{self.name} of {self.equipment} was not set to {self.duty_cycle:.0%}"
        return await call_or_fail(ctx, request, to=self.equipment, done="set", what=what, kind=self.state_name)
