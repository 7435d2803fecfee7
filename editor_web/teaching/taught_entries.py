"""Entries and captures by reference, and the motion of an arm along them."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from typing import cast, get_args

import msgspec

from editor_web.teaching.teaching_messages import EntryPage, PrimitiveComparison, TagsBody, TaughtReference
from engine.bus import JsonBus
from engine.errors import FlexcellError
from engine.messages import Message
from engine.skills.entries import EntryChanged, EntryHistory, EntryList, EntryRecord
from engine.skills.motion_trace import Trace, TraceableKind
from engine.skills.teaching import Capture

_TRACEABLE = frozenset(get_args(TraceableKind))


@dataclass(frozen=True, kw_only=True)
class TaughtData:
    """The referenced data: the kind of an entry and its fields."""

    kind: str
    value: dict[str, object]


async def read_taught(bus: JsonBus, reference: TaughtReference) -> TaughtData:
    """Return the referenced data; raises FlexcellError if there is none."""
    if reference.capture:
        capture = await read_capture(bus, reference.capture)
        kind = capture.summary.form
        return TaughtData(kind=kind, value=msgspec.to_builtins(_value(capture)))
    request: dict[str, object] = {"kind": reference.kind, "name": reference.name}
    if reference.revision:
        answer = await bus.call("store/read_revision", {**request, "revision": reference.revision})
    else:
        answer = await bus.call("store/read_entry", request)
    return TaughtData(kind=reference.kind, value=msgspec.json.decode(answer, type=EntryRecord).value)


async def read_capture(bus: JsonBus, number: int) -> Capture:
    """Return a capture with its data; raises FlexcellError if there is none."""
    return msgspec.json.decode(await bus.call("teach/read_capture", {"id": number}), type=Capture)


def _value(capture: Capture) -> Message | dict[str, object]:
    match capture.summary.form:
        case "dmp":
            return cast("Message", capture.joint_dmp)
        case "cart_dmp":
            return cast("Message", capture.cart_dmp)
        case "trajectory":
            return cast("Message", capture.trajectory)
        case "pose":
            return cast("Message", capture.pose)
        case "joints":
            return {"joints": capture.joints, "names": capture.names}
        case "gripper":
            return cast("Message", capture.gripper)


async def trace(bus: JsonBus, arm: str, taught: TaughtData, *, most: int = 200) -> Trace:
    """Return the motion of an arm along taught data.

    Raises:
        FlexcellError: the data belongs to another arm, or has no poses.
    """
    if taught.kind not in _TRACEABLE:
        hint = f"these kinds have: {', '.join(sorted(_TRACEABLE))}"
        raise FlexcellError(f"an entry of kind {taught.kind} has no poses", hint=hint)
    request = {"kind": taught.kind, "value": taught.value, "most": most}
    return msgspec.json.decode(await bus.call(f"{arm}/trace_motion", request), type=Trace)


async def compare_primitive(bus: JsonBus, arm: str, reference: TaughtReference) -> PrimitiveComparison:
    """Return a recording and its primitive for comparison; an entry gives only one of them."""
    if not reference.capture:
        taught = await read_taught(bus, reference)
        motion = await trace(bus, arm, taught)
        is_primitive = taught.kind in ("dmp", "cart_dmp")
        return PrimitiveComparison(
            demonstration=None if is_primitive else motion,
            primitive=motion if is_primitive else None,
            joint_fit=None,
            cart_fit=None,
        )
    capture = await read_capture(bus, reference.capture)
    if capture.trajectory is None:
        value = msgspec.to_builtins(_value(capture))
        shown = await trace(bus, arm, TaughtData(kind=capture.summary.form, value=value))
        return PrimitiveComparison(demonstration=shown, primitive=None, joint_fit=None, cart_fit=None)
    recorded = await trace(bus, arm, TaughtData(kind="trajectory", value=msgspec.to_builtins(capture.trajectory)))
    learned = capture.cart_dmp or capture.joint_dmp
    fit = capture.cart_fit if capture.cart_dmp is not None else capture.joint_fit
    primitive = None
    if learned is not None:
        kind = "cart_dmp" if capture.cart_dmp is not None else "dmp"
        primitive = await trace(bus, arm, TaughtData(kind=kind, value=msgspec.to_builtins(learned)))
        if fit is not None:
            # The primitive starts at the first motion of the recording.
            later = tuple(time_s + fit.cut.start_s for time_s in primitive.times_s)
            primitive = msgspec.structs.replace(primitive, times_s=later)
    return PrimitiveComparison(
        demonstration=recorded, primitive=primitive, joint_fit=capture.joint_fit, cart_fit=capture.cart_fit
    )


async def write_tags(bus: JsonBus, body: TagsBody) -> None:
    """Replace the tags of an entry; its value is kept.

    Raises:
        FlexcellError: there is no such entry, or it was changed meanwhile.
    """
    named: dict[str, object] = {"kind": body.kind, "name": body.name}
    answer = await bus.call("store/read_entry", named)
    written = {
        **named,
        "value": msgspec.json.decode(answer, type=EntryRecord).value,
        "tags": body.tags,
        "expected_revision": body.revision,
        "by": "the dashboard",
        "reason": "other tags",
    }
    await bus.call("store/write_entry", written)


async def search_entries(bus: JsonBus, *, kind: str, text: str, limit: int) -> EntryPage:
    """Return the first matching entries, each with its last change.

    Raises:
        FlexcellError: the cell has no store.
    """
    answer = await bus.call("store/list_entries", {"kind": kind, "text": text})
    matching = msgspec.json.decode(answer, type=EntryList).entries
    shown = matching[:limit]
    rows = await asyncio.gather(*(_row(bus, *each) for each in shown))
    return EntryPage(entries=tuple(rows), total=len(matching))


async def _row(bus: JsonBus, kind: str, name: str, revision: int) -> EntryChanged:
    answer = await bus.call("store/read_history", {"kind": kind, "name": name})
    changes = msgspec.json.decode(answer, type=EntryHistory).changes
    return changes[-1] if changes else EntryChanged(kind=kind, name=name, revision=revision, deleted=False)
