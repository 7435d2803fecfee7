"""The typed kinds of named entries: what the value of each must look like."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Annotated, TypeVar

import msgspec

from engine.demonstration import Trajectory
from engine.errors import StoreError
from engine.messages import Message, Pose
from engine.nearness import near_names
from engine.primitive import CartDmp, CartOffsets, JointDmp
from engine.skills.entries import EntryRecord

T = TypeVar("T")

RECORD = "record"
"""The kind of free records: any JSON object."""

_UNIT_TOLERANCE = 1e-3


class Joints(Message, frozen=True, kw_only=True):
    """A joint configuration in radians (metres for sliding joints), in the order of `names` or of the robot."""

    joints: Annotated[tuple[float, ...], msgspec.Meta(min_length=1)]
    names: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.names and len(self.names) != len(self.joints):
            raise ValueError(f"{len(self.joints)} joints but {len(self.names)} names")


@dataclass(frozen=True)
class EntryKind:
    """One kind: the type its values have (None for any object) and a check beyond the type.

    `check` returns what is wrong in words, empty when nothing is.
    """

    type: type[msgspec.Struct] | None
    check: Callable[[msgspec.Struct], str] | None = None


def _check_pose(value: msgspec.Struct) -> str:
    norm = math.hypot(*value.xyzw) if isinstance(value, Pose) else 1.0
    return "" if abs(norm - 1.0) <= _UNIT_TOLERANCE else f"the quaternion xyzw has length {norm:.4g} instead of 1"


STANDARD_KINDS: Mapping[str, EntryKind] = {
    "joints": EntryKind(Joints),
    "pose": EntryKind(Pose, _check_pose),
    "dmp": EntryKind(JointDmp),
    "cart_dmp": EntryKind(CartDmp),
    "cart_offsets": EntryKind(CartOffsets),
    "trajectory": EntryKind(Trajectory),
    RECORD: EntryKind(None),
}
"""The kinds every store knows; give a store a larger mapping to register more."""


def verified_value(kinds: Mapping[str, EntryKind], kind: str, value: object, *, where: str) -> object:
    """Return `value` as the type of its kind, defaults filled in; plain for a free record.

    Raises:
        StoreError: no such kind, or the value is not of it; the message names the field.
    """
    known = kinds.get(kind)
    if known is None:
        raise StoreError(f"there is no kind of entry called {kind!r}", where=where, hint=near_names(kind, kinds))
    plain = msgspec.to_builtins(value) if isinstance(value, msgspec.Struct) else value
    if known.type is None:
        return plain
    try:
        typed = msgspec.convert(plain, known.type)
    except (msgspec.ValidationError, RecursionError) as error:
        raise StoreError(
            f"this is no {kind}: {error}", where=where, hint=f"give the fields {_fields(known.type)}"
        ) from error
    if known.check is not None and (fault := known.check(typed)):
        raise StoreError(f"this is no {kind}: {fault}", where=where)
    return typed


def read_as(record: EntryRecord, kind: type[T]) -> T:
    """Return the value of an entry as `kind`, such as `Pose` or `Joints`.

    Raises:
        StoreError: the entry holds something else.
    """
    try:
        return msgspec.convert(record.value, kind)
    except msgspec.ValidationError as error:
        raise StoreError(
            f"this entry does not read as {kind.__name__}: {error}", where=f"{record.kind} {record.name}"
        ) from error


def _fields(kind: type[msgspec.Struct]) -> str:
    return ", ".join(field.encode_name for field in msgspec.structs.fields(kind))
