"""The typed kinds of named entries and the validation of their values."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Annotated, TypeVar

import msgspec

from engine.errors import StoreError
from engine.messages import Message, Pose
from engine.messages.demonstrations import Trajectory
from engine.messages.detection_template import DetectionTemplate
from engine.messages.primitives import CartDmp, CartOffsets, JointDmp
from engine.skills.entries import EntryRecord
from engine.skills.gripper import GripperSetting
from engine.store.pydantic_models import PydanticModel, fields_of_model, first_fault, is_model_type
from engine.wording.misfit import explain_misfit
from engine.wording.suggestions import did_you_mean

T = TypeVar("T")

RECORD = "record"
"""The kind of free records: any JSON object."""

_UNIT_TOLERANCE = 1e-3


class Joints(Message, frozen=True, kw_only=True):
    """A joint configuration in radians (metres for sliding joints), in the order of `names` or of the robot.

    `model` is the model of the robot it was taught with; empty when unknown.
    """

    joints: Annotated[tuple[float, ...], msgspec.Meta(min_length=1)]
    names: tuple[str, ...] = ()
    model: str = ""

    def __post_init__(self) -> None:
        if self.names and len(self.names) != len(self.joints):
            raise ValueError(f"{len(self.joints)} joints but {len(self.names)} names")


@dataclass(frozen=True)
class EntryKind:
    """One kind: the type of its values (None for any object) and an additional check.

    The type is a msgspec Struct or a pydantic model. `check` returns the problem, empty when there is none.
    """

    type: type[msgspec.Struct | PydanticModel] | None
    check: Callable[[msgspec.Struct], str] | None = None


def _check_pose(value: msgspec.Struct) -> str:
    return _fault_of_quaternion("the pose", value if isinstance(value, Pose) else None)


def _check_template(value: msgspec.Struct) -> str:
    assert isinstance(value, DetectionTemplate)
    return _fault_of_quaternion("pose", value.pose) or _fault_of_quaternion("camera_pose", value.camera_pose)


def _fault_of_quaternion(what: str, pose: Pose | None) -> str:
    norm = 1.0 if pose is None else math.hypot(*pose.xyzw)
    return "" if abs(norm - 1.0) <= _UNIT_TOLERANCE else f"the quaternion of {what} has length {norm:.4g} instead of 1"


STANDARD_KINDS: Mapping[str, EntryKind] = {
    "joints": EntryKind(Joints),
    "pose": EntryKind(Pose, _check_pose),
    "dmp": EntryKind(JointDmp),
    "cart_dmp": EntryKind(CartDmp),
    "cart_offsets": EntryKind(CartOffsets),
    "trajectory": EntryKind(Trajectory),
    "gripper": EntryKind(GripperSetting),
    "detection": EntryKind(DetectionTemplate, _check_template),
    RECORD: EntryKind(None),
}
"""The kinds of every store; pass a larger mapping to a store to register more."""


def verified_value(kinds: Mapping[str, EntryKind], kind: str, value: object, *, where: str) -> object:
    """Return `value` as the type of its kind with defaults filled in; as plain data for a free record.

    Raises:
        StoreError: there is no such kind, or the value is invalid; the message names the field.
    """
    known = kinds.get(kind)
    if known is None:
        raise StoreError(f"there is no kind of entry called {kind!r}", where=where, hint=did_you_mean(kind, kinds))
    plain = _plain(value)
    if known.type is None:
        return plain
    if is_model_type(known.type):
        return _validated_by_model(known.type, kind, plain, where=where)
    assert issubclass(known.type, msgspec.Struct)
    try:
        typed = msgspec.convert(plain, known.type)
    except (msgspec.ValidationError, RecursionError) as error:
        what = explain_misfit(error, known.type) if isinstance(error, msgspec.ValidationError) else str(error)
        hint = f"the fields are {_fields(known.type)}"
        raise StoreError(f"invalid {kind} entry: {what}", where=where, hint=hint) from error
    if known.check is not None and (fault := known.check(typed)):
        raise StoreError(f"invalid {kind} entry: {fault}", where=where)
    return typed


def decode_entry(record: EntryRecord, kind: type[T]) -> T:
    """Return the value of an entry as `kind`, such as `Pose` or `Joints`.

    Raises:
        StoreError: the entry has another type.
    """
    try:
        if is_model_type(kind):
            return kind.model_validate(record.value)
        return msgspec.convert(record.value, kind)
    except ValueError as error:
        raise StoreError(
            f"this entry is not a {kind.__name__}: {first_fault(error)}", where=f"{record.kind} {record.name}"
        ) from error


def _plain(value: object) -> object:
    if isinstance(value, msgspec.Struct):
        return msgspec.to_builtins(value)
    return value.model_dump(mode="json") if isinstance(value, PydanticModel) and not isinstance(value, type) else value


def _validated_by_model(model: type[PydanticModel], kind: str, plain: object, *, where: str) -> object:
    """Return the value with the defaults of the model, as plain data."""
    try:
        return model.model_validate(plain).model_dump(mode="json")
    except (ValueError, RecursionError) as error:
        fault = first_fault(error) if isinstance(error, ValueError) else "it is nested too deeply"
        raise StoreError(
            f"invalid {kind} entry: {fault}", where=where, hint=f"the fields are {', '.join(fields_of_model(model))}"
        ) from error


def _fields(kind: type[msgspec.Struct]) -> str:
    return ", ".join(field.encode_name for field in msgspec.structs.fields(kind))
