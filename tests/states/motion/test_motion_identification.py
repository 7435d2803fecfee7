"""The states that identify payload and friction."""

from __future__ import annotations

import pytest

from engine.errors import Cause
from engine.skills import identification
from engine.skills.collision_options import CollisionOptions
from engine.skills.goal_end import GoalEnd, GoalStatus
from engine.skills.identification import FrictionEstimate, JointFrictionEstimate, PayloadEstimate
from engine.state import Outcome
from states.motion.identify_friction import IdentifyFriction
from states.motion.identify_payload import IdentifyPayload
from tests.states.fake_context import FakeContext, broken_off

LOST = Cause(message="the world is gone", where="left", kind="RobotError")
ESTIMATE = PayloadEstimate(
    mass_kg=1.2, com_m=(0.0, 0.01, 0.05), mass_uncertainty_kg=0.04, com_uncertainty_m=0.004,
    residual_n=0.2, residual_nm=0.01, samples=1200,
)  # fmt: skip
OUTPUTS = {"mass_kg": 1.2, "com_m": (0.0, 0.01, 0.05), "mass_uncertainty_kg": 0.04, "com_uncertainty_m": 0.004}


def weighed() -> FakeContext:
    """An arm that identifies 1.2 kg."""
    return FakeContext({"left/identify_payload": GoalEnd(GoalStatus.SUCCEEDED, ESTIMATE, None)})


async def test_a_payload_is_written_as_set_load_takes_it() -> None:
    ctx = weighed()
    assert await IdentifyPayload(robot="left", amplitude_rad=0.4).run(ctx) == Outcome("identified", OUTPUTS)
    assert ctx.sent == [("left/identify_payload", identification.IdentifyPayload(amplitude_rad=0.4))]


async def test_a_payload_that_is_not_sure_enough_is_another_outcome_with_both_numbers() -> None:
    outcome = await IdentifyPayload(robot="left", tolerance_kg=0.03).run(weighed())
    assert (outcome.name, outcome.outputs) == ("uncertain", OUTPUTS)
    assert outcome.cause is not None
    assert outcome.cause.chain()[-1].message == "the mass is 1.20 kg ± 0.04 kg, tolerance 0.03 kg"


async def test_frictions_are_written_one_a_joint() -> None:
    joint = JointFrictionEstimate(
        joint="elbow", coulomb_nm=0.9, viscous_nms_rad=0.4, coulomb_uncertainty_nm=0.1,
        viscous_uncertainty_nms_rad=0.2, residual_nm=0.05,
    )  # fmt: skip
    end = GoalEnd(GoalStatus.SUCCEEDED, FrictionEstimate(joints=(joint,), samples=600), None)
    ctx = FakeContext({"left/identify_friction": end})
    outcome = await IdentifyFriction(robot="left", joints=("elbow",)).run(ctx)
    assert outcome == Outcome("identified", {"friction": (joint,)})
    assert ctx.sent == [("left/identify_friction", identification.IdentifyFriction(joints=("elbow",)))]


@pytest.mark.parametrize(
    ("state", "skill"),
    [(IdentifyPayload(robot="left"), "identify_payload"), (IdentifyFriction(robot="left"), "identify_friction")],
)
async def test_a_failure_gives_the_reason_and_no_outputs(state: IdentifyPayload | IdentifyFriction, skill: str) -> None:
    outcome = await state.run(FakeContext({f"left/{skill}": broken_off(GoalStatus.ABORTED, LOST)}))
    assert (outcome.name, outcome.outputs) == ("failed", {})
    assert outcome.cause is not None
    assert outcome.cause.chain()[-1] == LOST
    assert state.resources() == ("left",)


async def test_both_pass_on_what_may_be_touched() -> None:
    fixture = CollisionOptions(may_touch=("fixture",))
    ctx = weighed()
    await IdentifyPayload(robot="left", collisions=fixture).run(ctx)
    joints = GoalEnd(GoalStatus.SUCCEEDED, FrictionEstimate(joints=(), samples=600), None)
    other = FakeContext({"left/identify_friction": joints})
    await IdentifyFriction(robot="left", collisions=fixture).run(other)
    assert [*ctx.sent, *other.sent] == [
        ("left/identify_payload", identification.IdentifyPayload(collisions=fixture)),
        ("left/identify_friction", identification.IdentifyFriction(collisions=fixture)),
    ]
