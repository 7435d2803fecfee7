"""Entries documents: named joint configurations, poses, motion primitives and records that seed a store.

    flexcell: 1
    joints:
      left_home: [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785]
    poses:
      left_above_pick: {xyz: [0.4, 0.1, 0.3], xyzw: [1, 0, 0, 0], frame: world}
    dmps: {}
    cart_dmps: {}
    cart_offsets: {}
    trajectories: {}
    records:
      tray: {rows: 4, columns: 6}

Joints are radians, positions metres, quaternions x y z w. In a store these are the kinds
`joints` (`{joints: […]}`), `pose`, `dmp`, `cart_dmp`, `cart_offsets`,
`trajectory` and `record`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Literal

from msgspec import Meta

from engine.document.conversion import Strict, convert
from engine.document.yaml_source import Source, load_source
from engine.document.yaml_writer import write_yaml
from engine.errors import DocumentError
from engine.messages import Pose
from engine.skills.entries import EntryRecord

EntryName = Annotated[
    str,
    Meta(pattern="^[a-z][a-z0-9_/.-]{0,127}$", description="Lower-case letters, digits, `_`, `/`, `.` and `-`"),
]
_QUATERNION_TOLERANCE = 1e-3
_SECTIONS = {
    "joints": "joints",
    "pose": "poses",
    "dmp": "dmps",
    "cart_dmp": "cart_dmps",
    "cart_offsets": "cart_offsets",
    "trajectory": "trajectories",
    "record": "records",
}


class EntriesDocument(Strict, frozen=True, kw_only=True):
    """Named entries as written; a name may be used once per kind."""

    flexcell: Literal[1]
    description: str = ""
    joints: dict[EntryName, Annotated[tuple[float, ...], Meta(min_length=1, description="Angles in radians")]] = {}
    poses: dict[EntryName, Pose] = {}
    dmps: dict[EntryName, dict[str, object]] = {}
    cart_dmps: dict[EntryName, dict[str, object]] = {}
    cart_offsets: dict[EntryName, dict[str, object]] = {}
    trajectories: dict[EntryName, dict[str, object]] = {}
    records: dict[EntryName, dict[str, object]] = {}


@dataclass(frozen=True, kw_only=True)
class Entries:
    """An entries document with the file it came from."""

    document: EntriesDocument
    file: Path
    source: Source = field(repr=False)

    def records(self) -> tuple[EntryRecord, ...]:
        """Return every entry in the form a store takes; `revision` is 0, for not stored yet."""
        document = self.document
        return (
            *(_record("joints", name, {"joints": list(angles)}) for name, angles in document.joints.items()),
            *(_record("pose", name, _plain_pose(pose)) for name, pose in document.poses.items()),
            *(_record("dmp", name, value) for name, value in document.dmps.items()),
            *(_record("cart_dmp", name, value) for name, value in document.cart_dmps.items()),
            *(_record("cart_offsets", name, value) for name, value in document.cart_offsets.items()),
            *(_record("trajectory", name, value) for name, value in document.trajectories.items()),
            *(_record("record", name, value) for name, value in document.records.items()),
        )

    def names(self) -> frozenset[str]:
        """Return the names of all entries, whatever their kind."""
        return frozenset(record.name for record in self.records())

    def names_by_kind(self) -> dict[str, frozenset[str]]:
        """Return the names of the entries of each kind."""
        return {kind: frozenset(getattr(self.document, section)) for kind, section in _SECTIONS.items()}


def load_entries(path: Path | str) -> Entries:
    """Read an entries document.

    Raises:
        DocumentError: the file cannot be read or is not valid; `where` is the position.
    """
    file = Path(path)
    source = load_source(file)
    document = convert(source, EntriesDocument)
    for name, pose in document.poses.items():
        if abs(math.hypot(*pose.xyzw) - 1.0) > _QUATERNION_TOLERANCE:
            raise DocumentError(
                f"the quaternion of `{name}` has length {math.hypot(*pose.xyzw):.4g}, not 1",
                where=source.position(("poses", name, "xyzw")),
                hint="its order is x y z w",
            )
    return Entries(document=document, file=file, source=source)


def write_entries(records: Iterable[EntryRecord]) -> str:
    """Return the entries document that holds these records, sorted by kind and name.

    Raises:
        DocumentError: a record is of a kind that entries documents do not have.
    """
    sections: dict[str, dict[str, object]] = {section: {} for section in _SECTIONS.values()}
    for record in sorted(records, key=lambda record: (record.kind, record.name)):
        if record.kind not in _SECTIONS:
            raise DocumentError(f"entries of kind `{record.kind}` cannot be written", where=record.name)
        value: object = record.value["joints"] if record.kind == "joints" else record.value
        sections[_SECTIONS[record.kind]][record.name] = value
    return write_yaml({"flexcell": 1, **{key: section for key, section in sections.items() if section}})


def _record(kind: str, name: str, value: dict[str, object]) -> EntryRecord:
    return EntryRecord(kind=kind, name=name, value=value, revision=0)


def _plain_pose(pose: Pose) -> dict[str, object]:
    return {"xyz": list(pose.xyz), "xyzw": list(pose.xyzw), "frame": pose.frame}
