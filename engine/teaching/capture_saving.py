"""Writes a capture to the store as a named entry, in the requested form."""

from __future__ import annotations

import msgspec

from engine.bus import SkillBus
from engine.errors import BusError, SkillFailed
from engine.messages import Message, Pose, RobotDescription
from engine.skills.dmp import LearnCartDmp, LearnJointDmp
from engine.skills.entries import EntryRecord, WriteEntry
from engine.skills.motion import ForwardKinematics
from engine.skills.teaching import Capture, CaptureForm, SaveCapture
from engine.store.entry_kinds import Joints

_STORE = "store"


async def save_capture(bus: SkillBus, capture: Capture, request: SaveCapture) -> tuple[EntryRecord, Capture]:
    """Return the written entry, and the capture with the entry in `saved_as`.

    Raises:
        FlexcellError: the capture has no such form, the entry exists, or the store rejects it.
    """
    form = request.form or capture.summary.form
    value, known = await _value(bus, capture, form)
    record = await bus.call(
        WriteEntry(
            kind=form,
            name=request.name,
            value=msgspec.to_builtins(value),
            # 0: only if there is no entry.
            expected_revision=None if request.replace else 0,
            tags=request.tags or None,
            by=request.by,
            reason=request.reason or f"taught with {capture.summary.trigger}",
        ),
        to=_STORE,
    )
    saved = (*known.summary.saved_as, f"{form} {request.name}")
    summary = msgspec.structs.replace(known.summary, saved_as=tuple(dict.fromkeys(saved)))
    return record, msgspec.structs.replace(known, summary=summary)


async def _value(bus: SkillBus, capture: Capture, form: CaptureForm) -> tuple[Message, Capture]:
    """Return the value of an entry, and the capture with the values computed for it."""
    robot = capture.summary.robot
    match form:
        case "joints" if capture.joints:
            return Joints(joints=capture.joints, names=capture.names, model=_model(bus, robot)), capture
        case "pose" if capture.pose is not None or capture.joints:
            pose = capture.pose or await _pose(bus, capture)
            return pose, msgspec.structs.replace(capture, pose=pose)
        case "gripper" if capture.gripper is not None:
            return capture.gripper, capture
        case "trajectory" if capture.trajectory is not None:
            return capture.trajectory, capture
        case "dmp" if capture.trajectory is not None:
            if capture.joint_dmp is None:
                learned = await bus.call(LearnJointDmp(trajectory=capture.trajectory), to=robot)
                capture = msgspec.structs.replace(capture, joint_dmp=learned.dmp, joint_fit=learned.fit)
            assert capture.joint_dmp is not None
            return capture.joint_dmp, capture
        case "cart_dmp" if capture.trajectory is not None:
            if capture.cart_dmp is None:
                cart = await bus.call(LearnCartDmp(trajectory=capture.trajectory), to=robot)
                capture = msgspec.structs.replace(capture, cart_dmp=cart.dmp, cart_fit=cart.fit)
            assert capture.cart_dmp is not None
            return capture.cart_dmp, capture
        case _:
            raise SkillFailed(
                f"capture {capture.summary.id} cannot be saved as {form}",
                where="teach",
                hint="a configuration can be saved as joints or pose, a recording in any form",
            )


def _model(bus: SkillBus, robot: str) -> str:
    """Return the model of a robot; empty if it does not report one."""
    try:
        latest = bus.find_topic(f"{robot}/description").latest
    except BusError:
        return ""
    return latest.model if isinstance(latest, RobotDescription) else ""


async def _pose(bus: SkillBus, capture: Capture) -> Pose:
    return await bus.call(ForwardKinematics(joints=capture.joints), to=capture.summary.robot)
