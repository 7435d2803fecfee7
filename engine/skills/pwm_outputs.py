"""Outputs of equipment that switch on and off many times a second (pulse width modulation)."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.messages import Message
from engine.skill import Service
from engine.skills.switch_result import SwitchResult

DutyCycle = Annotated[float, Meta(ge=0.0, le=1.0, description="Part of each period in which the output is on, 0 to 1")]


class PwmOutputs(Message, frozen=True, kw_only=True):
    """The duty cycle of each PWM output by name, 0 to 1; the latest value of `<equipment>/pwm_outputs`.

    With a `problem` nothing is known, and there are no `duty_cycles`.
    """

    duty_cycles: dict[str, float]
    problem: str = ""


class SetDutyCycle(Service[SwitchResult], frozen=True, kw_only=True):
    """Set the duty cycle of a PWM output; its frequency is that of the equipment document."""

    name: Annotated[str, Meta(min_length=1, description="Name of a PWM output of the equipment")]
    duty_cycle: DutyCycle
