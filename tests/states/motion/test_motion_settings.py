"""The states that change how an arm behaves: what they ask, and what becomes of a refusal."""

from __future__ import annotations

from typing import Any

import pytest

from engine.errors import LeaseRefused, NoSuchSkill, SkillFailed
from engine.skill import Service
from engine.skills import arm_control
from engine.skills.arm_control import (
    RecoverFromError,
    SetCartesianImpedance,
    SetCollisionBehavior,
    SetEndEffectorFrame,
    SetJointImpedance,
    SetSpeedOverride,
)
from engine.state import Outcome, State
from states.motion.recover import Recover
from states.motion.set_collision import SetCollision
from states.motion.set_controller import SetController
from states.motion.set_impedance import SetImpedance
from states.motion.set_load import SetLoad
from states.motion.set_speed import SetSpeed
from states.motion.set_tool_frame import SetToolFrame
from tests.states.fake_context import FakeContext

SIX = (800.0, 800.0, 300.0, 40.0, 40.0, 40.0)
ASKED: list[tuple[State, Service[Any], str]] = [
    (SetSpeed(robot="left", share=0.4), SetSpeedOverride(share=0.4), "set"),
    (
        SetController(robot="left", controller="cartesian_impedance"),
        arm_control.SetController(controller="cartesian_impedance"),
        "set",
    ),
    (SetImpedance(robot="left", joints=(300.0, 200.0)), SetJointImpedance(stiffness_nm_rad=(300.0, 200.0)), "set"),
    (SetImpedance(robot="left", tool=SIX), SetCartesianImpedance(stiffness=SIX), "set"),
    (SetLoad(robot="left", mass_kg=1.5), arm_control.SetLoad(mass_kg=1.5), "set"),
    (SetToolFrame(robot="left", xyz_m=(0.0, 0.0, 0.1)), SetEndEffectorFrame(xyz_m=(0.0, 0.0, 0.1)), "set"),
    (SetCollision(robot="left", force_n=30.0), SetCollisionBehavior(force_n=30.0), "set"),
    (Recover(robot="left"), RecoverFromError(), "recovered"),
]
IDS = [type(state).__name__ for state, _, _ in ASKED]


@pytest.mark.parametrize(("state", "request_", "done"), ASKED, ids=IDS)
async def test_a_state_asks_the_arm_for_what_it_says(state: Any, request_: Service[Any], done: str) -> None:
    """One request."""
    address = f"left/{request_.skill_name()}"
    ctx = FakeContext({address: object()})
    assert await state.run(ctx) == Outcome(done)
    assert ctx.sent == [(address, request_)]


@pytest.mark.parametrize(("state", "request_", "done"), ASKED, ids=IDS)
@pytest.mark.parametrize("error", [SkillFailed("cannot be", where="left"), LeaseRefused("held by run b")])
async def test_a_refusal_is_an_outcome_with_the_reason_below(
    state: Any, request_: Service[Any], done: str, error: Exception
) -> None:
    """A behavior can handle it."""
    outcome = await state.run(FakeContext({f"left/{request_.skill_name()}": error}))
    assert outcome.name == "failed"
    assert outcome.cause.where == "root/step"
    assert outcome.cause.message.startswith("left ")
    assert outcome.cause.chain()[-1].message == str(error.args[0])


async def test_an_arm_without_the_service_is_an_error_of_the_behavior() -> None:
    """Not an outcome."""
    with pytest.raises(NoSuchSkill):
        await SetLoad(robot="left", mass_kg=1.0).run(FakeContext())


@pytest.mark.parametrize("given", [{}, {"joints": (1.0,), "tool": SIX}])
def test_a_stiffness_is_of_the_joints_or_of_the_tool(given: dict[str, Any]) -> None:
    """Not of neither or both."""
    with pytest.raises(ValueError, match="either `joints` or `tool`"):
        SetImpedance(robot="left", **given)


def test_all_but_the_speed_command_the_arm() -> None:
    """Another branch may slow down what this one moves."""
    assert {type(state).__name__: state.resources() for state, _, _ in ASKED if not state.resources()} == {
        "SetSpeed": ()
    }
