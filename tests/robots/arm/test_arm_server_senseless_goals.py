"""Goals with numbers that make no sense: refused in words or carried out, never a fault, and the next goal works."""

from __future__ import annotations

import asyncio
import functools
import inspect
import logging
from typing import Annotated, Any, Literal, Union, cast, get_args, get_origin, get_type_hints

import msgspec
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from engine.bus import GoalEnd, GoalStatus, SkillBus
from engine.clock import run_virtual
from engine.errors import FlexcellError
from engine.messages import Pose
from engine.messages.demonstrations import Trajectory
from engine.messages.primitives import CartDmp, CartOffsets, ForceReference, JointDmp
from engine.skill import Action, Service, Skill
from engine.skills import arm_control, contact, dmp, guiding, jogging, motion, waypoints
from engine.skills import direct_control as direct
from robots.motion.dmp import no_offsets
from robots.motion.min_jerk import min_jerk
from tests.robots.arm.every_skill import cart_dmp, joint_dmp
from tests.robots.arm.served import HOME, Served, served
from tests.robots.panda_arm import home, panda_kinematics

WILD = (
    float("nan"), float("inf"), -float("inf"), 1.7e308, -1.7e308, 1e160, 1e300, -1e12, 1e9, 1e-9, 5e-324, 0.0,
    -0.0, 1.0, 0.1,
)  # fmt: skip
NUMBERS = st.sampled_from(WILD) | st.floats(-3.0, 3.0)
LEFT_RUNNING_S = 0.3
# What a goal that nobody can carry out may say, in longest words.
MOST_WORDS = 2000

MODULES = (arm_control, contact, direct, dmp, guiding, jogging, motion, waypoints)


def _is_skill(kind: type[Any]) -> bool:
    return issubclass(kind, Action | Service) and kind.__module__.startswith("engine.skills.")


KINDS = cast("list[type[Any]]", [kind for module in MODULES for _, kind in inspect.getmembers(module, inspect.isclass)])
SKILLS: list[type[Skill[Any]]] = sorted(
    {kind for kind in KINDS if _is_skill(kind)},
    key=lambda kind: kind.__name__,
)


def values_of(kind: Any) -> st.SearchStrategy[Any]:
    """Return values of an annotated type as the bus would let them pass, wild ones among them."""
    if kind in _bases():
        return _changed(_bases()[kind])
    if kind is Pose:
        quaternion = st.just((1.0, 0.0, 0.0, 0.0)) | st.tuples(*(values_of(float),) * 4)
        return st.builds(Pose, xyz=st.tuples(*(values_of(float),) * 3), xyzw=quaternion)
    origin, arguments = get_origin(kind), get_args(kind)
    if origin is Annotated:
        return values_of(arguments[0]).filter(lambda value: _passes(value, kind))
    if origin is Literal:
        return st.sampled_from(arguments)
    if origin is tuple:
        if len(arguments) == 2 and arguments[1] is Ellipsis:
            one = values_of(arguments[0])
            return st.lists(one, max_size=8).map(tuple) | st.tuples(*(one,) * 7)
        return st.tuples(*map(values_of, arguments))
    if origin is Union or origin is type(int | str):
        return st.one_of(*map(values_of, arguments))
    if isinstance(kind, type) and issubclass(kind, msgspec.Struct):
        return _structs(kind)
    plain: dict[Any, st.SearchStrategy[Any]] = {
        float: NUMBERS,
        int: st.sampled_from((0, 1, 2, 184)),
        bool: st.booleans(),
        str: st.sampled_from(("", "world", "moon", "left/panda_link0")),
        type(None): st.none(),
    }
    return plain[kind]


def _passes(value: object, kind: Any) -> bool:
    try:
        msgspec.convert(value, kind)
    except msgspec.ValidationError:
        return False
    return True


def _structs(kind: type[msgspec.Struct]) -> st.SearchStrategy[Any]:
    hints = get_type_hints(kind, include_extras=True)
    required, optional = dict[str, st.SearchStrategy[Any]](), dict[str, st.SearchStrategy[Any]]()
    for field in msgspec.structs.fields(kind):
        (required if field.required else optional)[field.name] = values_of(hints[field.name])
    return st.fixed_dictionaries(required, optional=optional).map(lambda given_: _made(kind, given_)).filter(bool)


def _made(kind: Any, values: dict[str, Any]) -> Any:
    """Return the message, or None where its own check refuses it, as the bus would."""
    try:
        return kind(**values)
    except ValueError:
        return None


def _changed(base: msgspec.Struct) -> st.SearchStrategy[Any]:
    """Return a sensible message with up to two senseless fields, rows of numbers as long as they were."""
    hints = get_type_hints(type(base), include_extras=True)
    wild = {
        name: _like(cast("tuple[Any, ...]", value)) if isinstance(value, tuple) else values_of(hints[name])
        for name, value in msgspec.structs.asdict(base).items()
        if name not in ("N", "N_f", "id", "frame", "tasktrans")
    }
    changes = st.lists(st.sampled_from(sorted(wild)), max_size=2, unique=True).flatmap(
        lambda names: st.fixed_dictionaries({name: wild[name] for name in names})
    )
    values = msgspec.structs.asdict(base)
    return changes.map(lambda changed: _made(type(base), values | changed)).filter(bool)


def _like(row: tuple[Any, ...]) -> st.SearchStrategy[Any]:
    return st.tuples(*(_like(cast("tuple[Any, ...]", value)) if isinstance(value, tuple) else NUMBERS for value in row))


@functools.cache
def _bases() -> dict[Any, msgspec.Struct]:
    return {
        JointDmp: joint_dmp(home(), tuple(home().tolist())),
        CartDmp: cart_dmp(home()),
        ForceReference: ForceReference.constant(force_n=(0.0, 0.0, 5.0)),
        CartOffsets: no_offsets(2, a_x=2.0),
        dmp.Compliance: dmp.Compliance(),
        Trajectory: led(),
    }


def led() -> Trajectory:
    """The arm led a little, in twenty samples."""
    share = min_jerk(np.linspace(0.0, 1.0, 20))
    joints = home() + 0.1 * share[:, None]
    tools = [panda_kinematics().tool_pose(row) for row in joints]
    poses = tuple((*tool.xyz.tolist(), *tool.xyzw.tolist()) for tool in tools)
    times = tuple(np.linspace(0.0, 1.0, 20).tolist())
    return Trajectory(times_s=times, joints=tuple(map(tuple, joints.tolist())), poses=poses)


def everything_in_words(end: GoalEnd[Any]) -> None:
    """Fail where a goal ended by an error that nobody meant, or says too much."""
    cause = end.cause
    while cause is not None:
        assert len(cause.message) < MOST_WORDS
        cause = cause.because


async def performed(cell: Served, goal: Action[Any, Any]) -> None:
    """Send a goal, let it run for a while, cancel it, and move on."""
    handle = cell.bus.send_goal(goal, to="left")
    await asyncio.wait({asyncio.ensure_future(handle.result())}, timeout=LEFT_RUNNING_S)
    handle.cancel()
    everything_in_words(await asyncio.wait_for(handle.result(), 2.0))


async def asked(bus: SkillBus, request: Service[Any]) -> None:
    """Ask, and take no for an answer."""
    refusal = ""
    try:
        await bus.call(request, to="left")
    except FlexcellError as error:
        refusal = error.message
    assert "service raised" not in refusal, refusal
    assert len(refusal) < MOST_WORDS


@pytest.mark.parametrize("kind", SKILLS, ids=lambda kind: kind.__name__)
@settings(
    max_examples=12,
    deadline=None,
    derandomize=True,
    suppress_health_check=(HealthCheck.too_slow, HealthCheck.filter_too_much),
)
@given(data=st.data())
def test_whatever_numbers_a_skill_is_given_it_answers_in_words_and_the_arm_goes_on(
    kind: type[Skill[Any]], data: st.DataObject
) -> None:
    request: Any = data.draw(values_of(kind))

    async def try_it() -> None:
        async with served() as cell:
            if issubclass(kind, Action):
                await performed(cell, request)
            else:
                await asked(cell.bus, request)
                await cell.bus.call(direct.SwitchDirectControl(on=False), to="left")
            for way in cell.port.followed:
                assert np.isfinite(way.position_rad).all()
                assert np.isfinite(way.velocity_rad_s).all()
            assert (await cell.bus.send_goal(HOME, to="left").result()).status is GoalStatus.SUCCEEDED

    faults: list[str] = []
    watch = logging.Handler()
    watch.emit = lambda record: faults.append(record.getMessage())
    log = logging.getLogger("flexcell.bus")
    log.addHandler(watch)
    try:
        run_virtual(try_it())
    finally:
        log.removeHandler(watch)
    assert not faults
