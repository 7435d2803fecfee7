"""Collects the data of taught steps, from the bus of a cell or from its document, and proposes a behavior."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

import msgspec

from engine.bus import SkillBus
from engine.cell.robot_models import tool_kinds
from engine.document.cell import Cell
from engine.errors import BusError, SkillFailed
from engine.messages import FramePoses, PartPoses, Pose, RobotDescription, Vector3
from engine.messages.pose_algebra import compose_poses
from engine.skills.entries import EntryRecord, ReadEntry
from engine.skills.gripper import GripperSetting
from engine.skills.motion import ForwardKinematics
from engine.skills.proposing import Proposal, ProposeBehavior, TaughtStep, ToolName
from engine.store.contract import Store
from engine.store.entry_kinds import Joints, decode_entry
from engine.teaching.behavior_proposal import build_proposal
from engine.teaching.step_roles import ObservedStep
from engine.wording.suggestions import did_you_mean

M = TypeVar("M", bound=msgspec.Struct)

_WORLD = "world"
_USUAL_TOOL = "gripper"
"""The kind of a tool that is not described."""


async def propose(bus: SkillBus, request: ProposeBehavior) -> Proposal:
    """Return the behavior that executes taught steps in an open cell.

    Raises:
        FlexcellError: an entry is missing, the arm is ambiguous, or the steps are inconsistent.
    """
    described = _described(bus)
    records = [await _record(bus, step) for step in request.steps]
    arm = _arm(request, tuple(described), records)
    taught = [await _known(bus, arm, step, record) for step, record in zip(request.steps, records, strict=True)]
    poses = _latest(bus, "cell/parts", PartPoses)
    parts: dict[str, Vector3 | None] = {name: pose.xyz for name, pose in poses.poses.items()} if poses else {}
    tool = request.options.tool or _kind_of(described[arm].tool_kind)
    made = build_proposal(taught, request.options, arm=arm, tool=tool, parts=parts)
    return msgspec.structs.replace(made, arms=tuple(described))


async def propose_offline(store: Store, cell: Cell, request: ProposeBehavior) -> Proposal:
    """Return the behavior that executes taught steps, from the store and the document of a cell alone.

    The pose of the tool at joint configurations is then unknown.

    Raises:
        FlexcellError: as `propose`.
    """
    records = [None if step.kind == "action" else await store.get(step.kind, step.name) for step in request.steps]
    arms = tuple(cell.document.robots)
    arm = _arm(request, arms, records)
    taught = [_plain(step, record) for step, record in zip(request.steps, records, strict=True)]
    parts: dict[str, Vector3 | None] = {name: part.at.xyz for name, part in cell.document.parts.items()}
    made = build_proposal(taught, request.options, arm=arm, tool=request.options.tool or _USUAL_TOOL, parts=parts)
    return msgspec.structs.replace(made, arms=arms)


def _described(bus: SkillBus) -> dict[str, RobotDescription]:
    """Return the descriptions of the robots of a bus, by name."""
    ending = "/description"
    topics = sorted(row.name for row in bus.listing() if row.kind == "topic" and row.name.endswith(ending))
    latest = {name.removesuffix(ending): bus.find_topic(name).latest for name in topics}
    return {name: one for name, one in latest.items() if isinstance(one, RobotDescription)}


def _kind_of(mechanism: str) -> ToolName:
    """Return the kind of the tools with a mechanism."""
    return next((kind.name for kind in tool_kinds().values() if mechanism in kind.mechanisms), _USUAL_TOOL)


async def _record(bus: SkillBus, step: TaughtStep) -> EntryRecord | None:
    return None if step.kind == "action" else await bus.call(ReadEntry(kind=step.kind, name=step.name), to="store")


def _arm(request: ProposeBehavior, arms: Sequence[str], records: Sequence[EntryRecord | None]) -> str:
    """Return the arm: the named one, the only one, or the one whose name begins the names of entries."""
    named = request.options.arm
    if named:
        if named not in arms:
            raise SkillFailed(f"there is no arm {named}", where="teach", hint=did_you_mean(named, arms))
        return named
    if len(arms) == 1:
        return arms[0]
    names = [record.name for record in records if record is not None]
    begun = [arm for arm in arms if any(name.startswith((f"{arm}_", f"{arm}/", f"{arm}.")) for name in names)]
    if len(begun) != 1:
        raise SkillFailed("the arm is ambiguous", where="teach", hint=f"name one of {', '.join(arms) or 'none'}")
    return begun[0]


def _plain(step: TaughtStep, record: EntryRecord | None) -> ObservedStep:
    """Return the data of an entry."""
    if record is None:
        return ObservedStep(step, held=step.name == "close")
    if record.kind == "gripper":
        did = decode_entry(record, GripperSetting)
        return ObservedStep(step, held=did.held, width_m=did.width_m if did.held else 0.0, force_n=did.force_n)
    if record.kind == "pose":
        pose = decode_entry(record, Pose)
        return ObservedStep(step, tool=pose if pose.frame == _WORLD else None, frame=pose.frame)
    return ObservedStep(step)


async def _known(bus: SkillBus, arm: str, step: TaughtStep, record: EntryRecord | None) -> ObservedStep:
    """Return the data of an entry, with the pose of the tool."""
    taught = _plain(step, record)
    if record is not None and record.kind == "joints":
        joints = decode_entry(record, Joints).joints
        return ObservedStep(step, tool=await bus.call(ForwardKinematics(joints=joints), to=arm))
    if record is not None and taught.frame != _WORLD:
        frames = _latest(bus, "cell/frames", FramePoses)
        if frames is not None and taught.frame in frames.names:
            row = frames.names.index(taught.frame)
            frame = Pose(xyz=frames.xyz[row], xyzw=frames.xyzw[row])
            return ObservedStep(step, tool=compose_poses(frame, decode_entry(record, Pose)), frame=taught.frame)
    return taught


def _latest(bus: SkillBus, topic: str, kind: type[M]) -> M | None:
    try:
        message = bus.find_topic(topic).latest
    except BusError:
        return None
    return message if isinstance(message, kind) else None
