"""The states that follow and learn movement primitives: what they ask for and how they word a failure."""

from __future__ import annotations

from typing import Any

import msgspec
import pytest

from engine.errors import Cause, EntryNotFound, SkillFailed
from engine.messages import Pose
from engine.messages.primitives import CartDmp, CartOffsets, JointDmp
from engine.skills.dmp import (
    CartAdmitDMP,
    CartAdmitResult,
    CartDMP,
    CartFit,
    JointDMP,
    JointFit,
    LearnedCartDmp,
    LearnedJointDmp,
    TrimInterval,
)
from engine.skills.entries import EntryRecord, ReadEntry, WriteEntry
from engine.skills.goal_end import GoalEnd, GoalStatus
from engine.skills.motion import CartMotionResult, CartTrapVel, JointMotionResult, JointTrapVel
from engine.state import Outcome
from states.motion.follow_cart_dmp import FollowCartDmp
from states.motion.follow_joint_dmp import FollowJointDmp
from states.motion.learn_dmp import LearnCartDmp, LearnJointDmp
from states.motion.motion_target import EntryTarget, PoseTarget
from states.motion.press_along_dmp import PressAlongDmp
from states.motion.primitive import CartDmpEntry, JointDmpEntry
from tests.states.fake_context import FakeContext, broken_off

HERE = Pose(xyz=(0.1, 0.2, 0.3))
DONE_JOINTS = GoalEnd(GoalStatus.SUCCEEDED, JointMotionResult(joints=(0.0,), duration_s=1.0), None)
DONE_CART = GoalEnd(GoalStatus.SUCCEEDED, CartMotionResult(pose=HERE, duration_s=1.0), None)
JOINT = JointDmp(
    N=1, a_z=48.0, a_x=2.0, tau=2.0, goal=(1.0, 0.0), y0=(0.25, 0.5), dy0=(0.0, 0.0),
    c=(0.5,), sigma=(1.0,), w=((0.0,), (0.0,)), tasktrans=(-1.0, 0.0, 0.0, 1.0),
)  # fmt: skip
CART = CartDmp(
    N=1, a_z=48.0, a_x=2.0, tau=2.0, goal=(0.5, 0.0, 0.2, 0.0, 0.0, 0.0, 1.0), y0=(0.4, 0.0, 0.2, 0.0, 0.0, 0.0, 1.0),
    c=(0.5,), sigma=(1.0,), w1=(0.0,), w2=(0.0,), w3=(0.0,), w4=(0.0,), w5=(0.0,), w6=(0.0,),
)  # fmt: skip
OFFSETS = CartOffsets(
    c_o=(0.5,), sigma_o=(1.0,), w1o=(0.0,), w2o=(0.0,), w3o=(-0.002,), w4o=(0.0,), w5o=(0.0,), w6o=(0.0,)
)
BELOW = Cause(message="joint 2 was held back", where="left")
CUT = TrimInterval(start_s=0.1, end_s=2.1)


def entry(kind: str, name: str, value: msgspec.Struct) -> EntryRecord:
    """As the store gives it."""
    return EntryRecord(kind=kind, name=name, value=msgspec.to_builtins(value), revision=1)


async def test_a_joint_primitive_is_read_when_the_state_runs_and_slowed_down() -> None:
    """Twice its duration, with another goal."""
    ctx = FakeContext({"store/read_entry": entry("dmp", "pour", JOINT), "left/joint_dmp": DONE_JOINTS})
    state = FollowJointDmp(robot="left", dmp=JointDmpEntry(entry="pour"), goal=(0.5, 0.5), time_scale=2.0)
    assert await state.run(ctx) == Outcome("reached")
    slow = msgspec.structs.replace(JOINT, tau=4.0)
    assert ctx.sent == [
        ("store/read_entry", ReadEntry(kind="dmp", name="pour")),
        ("left/joint_dmp", JointDMP(dmp=slow, goal=(0.5, 0.5))),
    ]
    assert state.resources() == ("left",)


async def test_the_arm_first_goes_to_the_start_when_it_is_asked_to() -> None:
    """To where the task transformation puts it; the primitive follows."""
    ctx = FakeContext(
        {
            "store/read_entry": entry("dmp", "pour", JOINT),
            "left/joint_trap_vel": DONE_JOINTS,
            "left/joint_dmp": DONE_JOINTS,
        }
    )
    state = FollowJointDmp(robot="left", dmp=JointDmpEntry(entry="pour"), approach_speed=0.2)
    assert await state.run(ctx) == Outcome("reached")
    assert ctx.sent[1:] == [
        ("left/joint_trap_vel", JointTrapVel(joints=(-0.25, 0.5), speed=0.2)),
        ("left/joint_dmp", JointDMP(dmp=JOINT)),
    ]


async def test_a_start_that_is_not_reached_fails_with_that_reason() -> None:
    """The primitive is not begun."""
    ctx = FakeContext(
        {"store/read_entry": entry("dmp", "pour", JOINT), "left/joint_trap_vel": broken_off(GoalStatus.ABORTED, BELOW)}
    )
    outcome = await FollowJointDmp(robot="left", dmp=JointDmpEntry(entry="pour"), approach_speed=0.2).run(ctx)
    message = "left did not reach the start of dmp entry pour: joint_trap_vel was aborted"
    cause = Cause(message=message, where="root/step", kind="motion.FollowJointDmp", because=BELOW)
    assert outcome == Outcome("failed", cause=cause)


async def test_a_refused_primitive_carries_the_planners_reason() -> None:
    """As every motion does."""
    ctx = FakeContext(
        {"store/read_entry": entry("dmp", "pour", JOINT), "left/joint_dmp": broken_off(GoalStatus.REJECTED, BELOW)}
    )
    outcome = await FollowJointDmp(robot="left", dmp=JointDmpEntry(entry="pour")).run(ctx)
    message = "left did not follow dmp entry pour to its end: joint_dmp was rejected"
    cause = Cause(message=message, where="root/step", kind="motion.FollowJointDmp", because=BELOW)
    assert outcome == Outcome("failed", cause=cause)


async def test_a_missing_primitive_is_an_error_that_names_it() -> None:
    """A typo in a behavior is no motion failure."""
    ctx = FakeContext({"store/read_entry": EntryNotFound("there is no dmp entry called por")})
    with pytest.raises(EntryNotFound, match="por"):
        await FollowJointDmp(robot="left", dmp=JointDmpEntry(entry="por"), goal=EntryTarget(entry="home")).run(ctx)


async def test_a_cartesian_primitive_is_followed_to_another_goal_from_its_start() -> None:
    """The start is approached in joint space; the goal is the entry's pose, moved."""
    ctx = FakeContext(
        {
            "store/read_entry": entry("cart_dmp", "wipe", CART),
            "left/cart_trap_vel": DONE_CART,
            "left/cart_dmp": DONE_CART,
        }
    )
    target = PoseTarget(xyz=(0.5, 0.25, 0.25))
    state = FollowCartDmp(
        robot="left", dmp=CartDmpEntry(entry="wipe"), goal=target, goal_offset_m=(0.0, 0.0, 0.5), approach_speed=0.3
    )
    assert await state.run(ctx) == Outcome("reached")
    assert ctx.sent == [
        ("store/read_entry", ReadEntry(kind="cart_dmp", name="wipe")),
        ("left/cart_trap_vel", CartTrapVel(pose=Pose(xyz=(0.4, 0.0, 0.2)), speed=0.3)),
        ("left/cart_dmp", CartDMP(dmp=CART, goal=Pose(xyz=(0.5, 0.25, 0.75)))),
    ]


@pytest.mark.parametrize("refused", ["cart_trap_vel", "cart_dmp"])
async def test_a_cartesian_primitive_that_fails_says_where(refused: str) -> None:
    """On the way to its start, or on its own way."""
    answers: dict[str, object] = {"left/cart_trap_vel": DONE_CART, "left/cart_dmp": DONE_CART}
    answers[f"left/{refused}"] = broken_off(GoalStatus.ABORTED, BELOW)
    ctx = FakeContext({"store/read_entry": entry("cart_dmp", "wipe", CART), **answers})
    outcome = await FollowCartDmp(robot="left", dmp=CartDmpEntry(entry="wipe"), approach_speed=0.3).run(ctx)
    words = {"cart_trap_vel": "did not reach the start of", "cart_dmp": "did not follow"}[refused]
    assert outcome.name == "failed"
    assert outcome.cause is not None
    assert words in outcome.cause.message
    assert outcome.cause.because == BELOW


class Store(FakeContext):
    """Answers for two kinds of entries; `learned` may be missing."""

    def __init__(self, answers: dict[str, object], *, learned: CartOffsets | None) -> None:
        super().__init__(answers)
        self._learned = learned

    async def call(self, request: Any, *, to: str) -> Any:
        """Give the primitive, the offsets, or what was scripted."""
        if not isinstance(request, ReadEntry):
            return await super().call(request, to=to)
        if request.kind == "cart_dmp":
            return entry("cart_dmp", request.name, CART)
        if self._learned is None:
            raise EntryNotFound("there is none")
        return entry("cart_offsets", request.name, self._learned)


@pytest.mark.parametrize("before", [None, OFFSETS])
async def test_pressing_uses_what_was_learned_before_and_keeps_what_it_learns(before: CartOffsets | None) -> None:
    """The first pass starts with nothing; the errors are outputs."""
    now = msgspec.structs.replace(OFFSETS, w3o=(-0.003,))
    result = CartAdmitResult(offsets=now, pose=HERE, force_error_rms_n=0.5, force_error_max_n=2.0, duration_s=3.0)
    answers: dict[str, object] = {
        "left/cart_admit_dmp": GoalEnd(GoalStatus.SUCCEEDED, result, None),
        "store/write_entry": entry("cart_offsets", "table", now),
    }
    ctx = Store(answers, learned=before)
    state = PressAlongDmp(robot="left", dmp=CartDmpEntry(entry="wipe"), force_n=(0.0, 0.0, 10.0), learned="table")
    assert await state.run(ctx) == Outcome("reached", {"force_error_rms_n": 0.5, "force_error_max_n": 2.0})
    sent = ctx.sent[0][1]
    assert isinstance(sent, CartAdmitDMP)
    assert (sent.offsets, sent.force.w3f) == (before, (10.0,))
    value = msgspec.to_builtins(now)
    assert ctx.sent[1] == ("store/write_entry", WriteEntry(kind="cart_offsets", name="table", value=value))


async def test_pressing_that_fails_learns_nothing() -> None:
    """And says why."""
    ctx = Store({"left/cart_admit_dmp": broken_off(GoalStatus.ABORTED, BELOW)}, learned=None)
    state = PressAlongDmp(robot="left", dmp=CartDmpEntry(entry="wipe"), force_n=(0.0, 0.0, 10.0), learned="table")
    outcome = await state.run(ctx)
    message = "left did not press along cart_dmp entry wipe to its end: cart_admit_dmp was aborted"
    cause = Cause(message=message, where="root/step", kind="motion.PressAlongDmp", because=BELOW)
    assert outcome == Outcome("failed", cause=cause)
    assert len(ctx.sent) == 1


async def test_a_learned_joint_primitive_is_stored_and_its_error_reported() -> None:
    """Under the name that is asked for."""
    fit = JointFit(kernels=25, rms_rad=0.001, max_rad=0.004, end_rad=0.0, joint=3, cut=CUT)
    ctx = FakeContext(
        {
            "left/learn_joint_dmp": LearnedJointDmp(dmp=JOINT, fit=fit),
            "store/write_entry": entry("dmp", "pour", JOINT),
        }
    )
    state = LearnJointDmp(robot="left", recording="led", save_as="pour", kernels=25)
    assert await state.run(ctx) == Outcome("learned", {"rms_rad": 0.001, "max_rad": 0.004})
    write = WriteEntry(kind="dmp", name="pour", value=msgspec.to_builtins(JOINT))
    assert ctx.sent[1] == ("store/write_entry", write)


async def test_a_learned_cartesian_primitive_is_stored_and_its_error_reported() -> None:
    fit = CartFit(kernels=25, rms_m=0.001, max_m=0.002, end_m=0.0, rms_rad=0.001, max_rad=0.004, end_rad=0.0, cut=CUT)
    ctx = FakeContext(
        {
            "left/learn_cart_dmp": LearnedCartDmp(dmp=CART, fit=fit),
            "store/write_entry": entry("cart_dmp", "wipe", CART),
        }
    )
    state = LearnCartDmp(robot="left", recording="led", save_as="wipe")
    assert await state.run(ctx) == Outcome("learned", {"max_m": 0.002, "max_rad": 0.004})


@pytest.mark.parametrize(
    ("state", "skill"),
    [
        (LearnJointDmp(robot="left", recording="led", save_as="x"), "learn_joint_dmp"),
        (LearnCartDmp(robot="left", recording="led", save_as="x"), "learn_cart_dmp"),
    ],
)
async def test_a_recording_that_nothing_is_learned_from_is_an_outcome(
    state: LearnJointDmp | LearnCartDmp, skill: str
) -> None:
    """With the reason below."""
    ctx = FakeContext({f"left/{skill}": SkillFailed("nothing moves in the recording", where="left")})
    outcome = await state.run(ctx)
    assert outcome.name == "failed"
    assert outcome.cause is not None
    assert [link.message for link in outcome.cause.chain()] == [
        "no movement primitive was learned from trajectory entry led",
        "nothing moves in the recording",
    ]


@pytest.mark.parametrize(
    ("state", "given", "message"),
    [
        (FollowJointDmp, {"robot": "l", "dmp": {"entry": ""}}, "dmp"),
        (FollowJointDmp, {"robot": "l", "dmp": {"entry": "a"}, "time_scale": 0}, "time_scale"),
        (FollowJointDmp, {"robot": "l", "dmp": {"entry": "a"}, "approach_speed": 2}, "approach_speed"),
        (FollowCartDmp, {"robot": "l", "dmp": {"entry": "a"}, "goal_offset_m": [0, 0, 1]}, "requires `goal`"),
        (PressAlongDmp, {"robot": "l", "dmp": {"entry": "a"}, "force_n": [0, 1]}, "force_n"),
        (LearnJointDmp, {"robot": "l", "recording": "a", "save_as": "b", "kernels": 185}, "kernels"),
    ],
)
def test_parameters_that_make_no_sense_are_refused(
    state: type[msgspec.Struct], given: dict[str, object], message: str
) -> None:
    """The document check finds it before anything moves."""
    with pytest.raises(msgspec.ValidationError, match=message):
        msgspec.convert(given, state)
