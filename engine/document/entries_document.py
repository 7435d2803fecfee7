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
    grippers: {}
    detections: {}
    records:
      tray: {rows: 4, columns: 6}
    tags:
      poses: {left_above_pick: [tested, station_1]}

Joints are radians, positions metres, quaternions x y z w; joints may also be written as
`{joints: […], names: […], model: panda}`. In a store these are the kinds `joints`, `pose`, `dmp`,
`cart_dmp`, `cart_offsets`, `trajectory`, `gripper`, `detection` and `record`. An entry that is not in
`tags` keeps its tags.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal, cast

from msgspec import Meta

from engine.document.text.decoding import StrictModel, decode_document
from engine.document.text.document_file import DocumentFile
from engine.document.text.yaml_source import load_source
from engine.document.text.yaml_writer import write_yaml
from engine.errors import DocumentError
from engine.messages import Pose
from engine.skills.entries import EntryRecord
from engine.wording.suggestions import did_you_mean

EntryName = Annotated[
    str,
    Meta(pattern="^[a-z][a-z0-9_/.-]{0,127}$", description="Lower-case letters, digits, `_`, `/`, `.` and `-`"),
]
Tag = Annotated[str, Meta(pattern="^[a-z0-9][a-z0-9_/.-]{0,63}$", description="Lower-case letters, digits, `_/.-`")]
_QUATERNION_TOLERANCE = 1e-3
SECTIONS = {
    "joints": "joints",
    "pose": "poses",
    "dmp": "dmps",
    "cart_dmp": "cart_dmps",
    "cart_offsets": "cart_offsets",
    "trajectory": "trajectories",
    "gripper": "grippers",
    "detection": "detections",
    "record": "records",
}
"""The section of each kind of entries."""
Section = Literal[
    "joints", "poses", "dmps", "cart_dmps", "cart_offsets", "trajectories", "grippers", "detections", "records"
]
Angles = Annotated[
    tuple[float, ...], Meta(min_length=1, description="Angles in radians", extra_json_schema={"unit": "rad"})
]


class NamedAngles(StrictModel, frozen=True, kw_only=True):
    """A joint configuration with the names of its joints and the model of its robot."""

    joints: Angles
    names: tuple[str, ...] = ()
    model: str = ""


class EntriesDocument(StrictModel, frozen=True, kw_only=True):
    """Named entries as written; a name may be used once per kind."""

    flexcell: Literal[1]
    description: str = ""
    joints: dict[EntryName, Angles | NamedAngles] = {}
    poses: dict[EntryName, Pose] = {}
    dmps: dict[EntryName, dict[str, object]] = {}
    cart_dmps: dict[EntryName, dict[str, object]] = {}
    cart_offsets: dict[EntryName, dict[str, object]] = {}
    trajectories: dict[EntryName, dict[str, object]] = {}
    grippers: dict[EntryName, dict[str, object]] = {}
    detections: dict[EntryName, dict[str, object]] = {}
    records: dict[EntryName, dict[str, object]] = {}
    tags: dict[Section, dict[EntryName, Annotated[tuple[Tag, ...], Meta(max_length=32)]]] = {}


@dataclass(frozen=True, kw_only=True)
class Entries(DocumentFile[EntriesDocument]):
    """An entries document with its file."""

    def records(self) -> tuple[EntryRecord, ...]:
        """Return every entry as a store record; `revision` is 0 for entries not yet stored."""
        return tuple(
            EntryRecord(kind=kind, name=name, value=_value(value), revision=0, tags=self._tags(section, name))
            for kind, section in SECTIONS.items()
            for name, value in getattr(self.document, section).items()
        )

    def _tags(self, section: str, name: str) -> tuple[str, ...] | None:
        for tagged, names in self.document.tags.items():
            if tagged == section and name in names:
                return names[name]
        return None

    def names(self) -> frozenset[str]:
        """Return the names of all entries, whatever their kind."""
        return frozenset(record.name for record in self.records())

    def names_by_kind(self) -> dict[str, frozenset[str]]:
        """Return the names of the entries of each kind."""
        return {kind: frozenset(getattr(self.document, section)) for kind, section in SECTIONS.items()}


def load_entries(path: Path | str) -> Entries:
    """Read an entries document.

    Raises:
        DocumentError: the file cannot be read or is not valid; `where` is the position.
    """
    file = Path(path)
    source = load_source(file)
    document = decode_document(source, EntriesDocument)
    for name, pose in document.poses.items():
        if abs(math.hypot(*pose.xyzw) - 1.0) > _QUATERNION_TOLERANCE:
            raise DocumentError(
                f"the quaternion of `{name}` has length {math.hypot(*pose.xyzw):.4g}, not 1",
                where=source.position(("poses", name, "xyzw")),
                hint="its order is x y z w",
            )
    for section, tagged in document.tags.items():
        for name in tagged:
            there: dict[str, object] = getattr(document, section)
            if name not in there:
                where = source.position(("tags", section, name), of_key=True)
                raise DocumentError(
                    f"there is no `{name}` under `{section}`", where=where, hint=did_you_mean(name, there)
                )
    return Entries(document=document, file=file, source=source)


def write_entries(records: Iterable[EntryRecord]) -> str:
    """Return the entries document that holds these records with their tags, sorted by kind and name.

    Raises:
        DocumentError: a record is of a kind that entries documents do not have.
    """
    sections: dict[str, dict[str, object]] = {section: {} for section in SECTIONS.values()}
    tags: dict[str, dict[str, object]] = {}
    for record in sorted(records, key=lambda record: (record.kind, record.name)):
        if record.kind not in SECTIONS:
            raise DocumentError(f"entries of kind `{record.kind}` cannot be written", where=record.name)
        section = SECTIONS[record.kind]
        sections[section][record.name] = _short(record.value) if record.kind == "joints" else record.value
        if record.tags:
            tags.setdefault(section, {})[record.name] = list(record.tags)
    filled = {key: section for key, section in sections.items() if section}
    return write_yaml({"flexcell": 1, **filled, **({"tags": tags} if tags else {})})


def _value(written: object) -> dict[str, object]:
    """Return the stored value of an entry as written."""
    if isinstance(written, tuple):
        return {"joints": list(cast("tuple[float, ...]", written))}
    if isinstance(written, Pose):
        return {"xyz": list(written.xyz), "xyzw": list(written.xyzw), "frame": written.frame}
    if isinstance(written, NamedAngles):
        return {"joints": list(written.joints), "names": list(written.names), "model": written.model}
    return cast("dict[str, object]", written)


def _short(value: dict[str, object]) -> object:
    """Return a joint configuration as a list if it has no other data."""
    present = {key: each for key, each in value.items() if each}
    return present["joints"] if present.keys() == {"joints"} else present
