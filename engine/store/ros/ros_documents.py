"""Converts named entries to and from documents of the ROS package `mongodb_store`.

Such a document has the fields of a ROS message and a `_meta` with its name and type; under ROS 2
the message is in a field `message`. ReconCycle stores joint configurations as
`sensor_msgs/JointState`, poses as `geometry_msgs` and primitives as `robot_module_msgs` (RCY 2.2).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any, cast

import msgspec

from engine.errors import StoreError
from engine.skills.entries import EntryRecord
from engine.store.entry_kinds import STANDARD_KINDS, verified_value
from engine.store.ros.ros_import import plain_bson
from engine.store.ros.ros_messages import from_message, to_message

Document = Mapping[str, Any]
_BAD = re.compile(r"[^a-z0-9_/.-]+")


class RosEntry(msgspec.Struct, frozen=True, kw_only=True):
    """An entry read from a document, with the name and the message type of the document.

    `kept` is the reason why an entry of a known type is a plain record; empty otherwise.
    """

    record: EntryRecord
    ros_name: str
    ros_type: str
    kept: str = ""


def entries_from_ros(documents: Iterable[Document]) -> tuple[RosEntry, ...]:
    """Return the entries in documents; of several with one name and kind the last, as `mongodb_store` does.

    Messages of other types become entries of kind `record`, with `ros_type` and `message`.

    Raises:
        StoreError: a document has no name or type, or two names become the same name in flexcell.
    """
    found: dict[tuple[str, str], RosEntry] = {}
    for number, document in enumerate(documents, 1):
        entry = _entry(document, number)
        key = (entry.record.kind, entry.record.name)
        if key in found and found[key].ros_name != entry.ros_name:
            raise StoreError(
                f"the names {found[key].ros_name!r} and {entry.ros_name!r} both become {entry.record.name!r}",
                where=f"document {number}",
                hint="rename one of them in the source",
            )
        found[key] = entry
    return tuple(found.values())


def ros_document(record: EntryRecord, *, inserted_by: str = "flexcell") -> dict[str, Any]:
    """Return an entry as a document of `mongodb_store`, as ROS 1 writes it.

    A value without a message type, such as a free record, becomes a `std_msgs/String` with its JSON.
    """
    ros_type, message = to_message(record)
    package, name = ros_type.split("/")
    return {
        **message,
        "_meta": {
            "name": record.name,
            "stored_type": ros_type,
            "stored_class": f"{package}.msg._{name}.{name}",
            "inserted_by": inserted_by,
            "flexcell": {"kind": record.kind},
        },
    }


def _entry(document: Document, number: int) -> RosEntry:
    meta = _object(document.get("_meta"))
    ros_type = str(meta.get("stored_type", "")).replace("/msg/", "/")
    ros_name = str(meta.get("name", ""))
    if not ros_type or not ros_name:
        raise StoreError(
            "the document has no `_meta` with `name` and `stored_type`",
            where=f"document {number}",
            hint="only named entries of mongodb_store can be read: `insert_named`",
        )
    try:
        found = plain_bson(document["message"] if "message" in document else _without_meta(document))
    except (ValueError, TypeError, OverflowError, RecursionError) as error:
        raise StoreError(
            f"the document cannot be read: {error}", where=f"document {number}", hint="exclude it"
        ) from error
    kind, value, kept = _value(ros_type, _object(found), str(_object(meta.get("flexcell")).get("kind", "")))
    record = EntryRecord(kind=kind, name=_name(ros_name), value=value, revision=0)
    return RosEntry(record=record, ros_name=ros_name, ros_type=ros_type, kept=kept)


def _value(ros_type: str, message: Mapping[str, Any], known: str) -> tuple[str, dict[str, object], str]:
    free: dict[str, object] = {"ros_type": ros_type, "message": dict(message)}
    try:
        found = from_message(ros_type, message, kind=known)
        if found is None:
            return "record", free, ""
        kind, value = found
        verified_value(STANDARD_KINDS, kind, value, where=ros_type)
    except (StoreError, KeyError, TypeError, ValueError) as error:
        # Data that is not a valid entry is not lost: it is kept as a record, with the reason.
        reason = f"the field {error} is missing" if isinstance(error, KeyError) else str(error)
        return "record", free, reason
    return kind, value, ""


def _object(value: object) -> Mapping[str, Any]:
    return cast("Mapping[str, Any]", value) if isinstance(value, Mapping) else {}


def _without_meta(document: Document) -> dict[str, Any]:
    return {key: value for key, value in document.items() if key not in ("_meta", "_id")}


def _name(ros_name: str) -> str:
    name = _BAD.sub("_", ros_name.lower())
    return (name if name[:1].isalpha() else f"n{name}")[:128]
