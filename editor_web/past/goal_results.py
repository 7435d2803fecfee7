"""What the goals of a run measured, as their results in its events say: contacts, grasps, forces of pressing."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import cast

import msgspec

from editor_web.past.measured_marker import MeasuredKind, MeasuredMarker
from engine.event import Event, GoalFinished, GoalSent
from engine.skills.contact import MoveUntilContact
from engine.skills.dmp import CartAdmitDMP
from engine.skills.gripper import GripperGrasp
from engine.skills.hand import HandClose

_GUARDED_MOVE = MoveUntilContact.skill_name()
_PRESSING = CartAdmitDMP.skill_name()
_TO_HOLD = frozenset({GripperGrasp.skill_name(), HandClose.skill_name()})
"""Skills that are to hold something: it is a fact, too, that they do not."""


class PerformedGoal(msgspec.Struct, frozen=True, kw_only=True):
    """A goal of a node at a device, from its request to its end; an open one ends at infinity."""

    path: str
    device: str
    skill: str
    request: dict[str, object]
    from_s: float
    until_s: float = math.inf

    @property
    def force_n(self) -> float | None:
        """The force that a guarded move asked for, newton; None for other goals."""
        return _number(self.request, "force_n") if self.skill == _GUARDED_MOVE else None


def performed_goals(events: Iterable[Event]) -> tuple[PerformedGoal, ...]:
    """Return the goals of a run, in the order in which they were sent."""
    goals: dict[str, PerformedGoal] = {}
    for event in events:
        if isinstance(event, GoalSent):
            device, _, skill = event.address.rpartition("/")
            goals[event.goal] = PerformedGoal(
                path=event.path, device=device, skill=skill, request=event.request, from_s=event.time_s
            )
        elif isinstance(event, GoalFinished) and event.goal in goals:
            goals[event.goal] = msgspec.structs.replace(goals[event.goal], until_s=event.time_s)
    return tuple(goals.values())


def goal_markers(events: Iterable[Event]) -> tuple[MeasuredMarker, ...]:
    """Return the markers of the results of goals, in order; they stand at the ends of the goals."""
    sent: dict[str, GoalSent] = {}
    markers: list[MeasuredMarker] = []
    for event in events:
        if isinstance(event, GoalSent):
            sent[event.goal] = event
        elif isinstance(event, GoalFinished) and event.goal in sent:
            marker = _marker(sent.pop(event.goal), event)
            if marker is not None:
                markers.append(marker)
    return tuple(markers)


def _marker(sent: GoalSent, end: GoalFinished) -> MeasuredMarker | None:
    result = end.result
    if result is None:
        return None
    device, _, skill = sent.address.rpartition("/")
    if skill == _GUARDED_MOVE and result.get("contact") is True:
        force_n, asked_n = _number(result, "force_n"), _number(sent.request, "force_n")
        text = f"{device} stopped at a contact after {_millimetres(_number(result, 'travelled_m'))}; at rest"
        return _made("contact", end, device, force_n, asked_n, text)
    if skill == _PRESSING and end.status == "succeeded":
        largest_n, rms_n = _number(result, "force_error_max_n"), _number(result, "force_error_rms_n")
        text = f"{device} pressed; its force was off by at most {_newtons(largest_n)}, RMS {_newtons(rms_n)}"
        return _made("force", end, device, largest_n, None, text)
    is_held = result.get("held")
    if is_held is True or (is_held is False and skill in _TO_HOLD):
        # Not every tool presses: some pull.
        force_n = _number(result, "force_n") if "force_n" in result else _number(result, "pull_n")
        return _made("grasp", end, device, force_n, _number(sent.request, "force_n"), _held_text(device, result))
    return None


def _made(
    kind: MeasuredKind, end: GoalFinished, device: str, force_n: float | None, asked_n: float | None, text: str
) -> MeasuredMarker:
    return MeasuredMarker(
        kind=kind, seq=end.seq, time_s=end.time_s, path=end.path, device=device,
        value=force_n, unit="N", limit=asked_n, text=text,
    )  # fmt: skip


def _held_text(device: str, result: Mapping[str, object]) -> str:
    if result.get("held") is not True:
        reason = str(result.get("reason", ""))
        return f"{device} holds nothing{reason and f': {reason}'}"
    part = str(result.get("part", "")) or "something"
    width_m = _number(result, "width_m")
    opening = "" if width_m is None else f", {_millimetres(width_m)} wide"
    return f"{device} holds {'an unknown part' if part == '?' else part}{opening}"


def _number(values: Mapping[str, object], key: str) -> float | None:
    value = values.get(key)
    return float(cast("float", value)) if isinstance(value, int | float) and not isinstance(value, bool) else None


def _millimetres(length_m: float | None) -> str:
    return "an unknown way" if length_m is None else f"{length_m * 1e3:.1f} mm"


def _newtons(force_n: float | None) -> str:
    return "an unknown force" if force_n is None else f"{force_n:.1f} N"
