"""What the telemetry of a recorded run shows: forces, joints at their limits, and what happened to real devices.

Pairs of bodies that touched are on no topic, so that contacts come from the results of goals alone. A recording has at
most `topic_rate_hz` messages of a topic each second: a shorter peak may be missing.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

import msgspec

from editor_web.past.goal_results import PerformedGoal
from editor_web.past.measured_marker import MeasuredKind, MeasuredMarker
from editor_web.past.recorded_curves import RecordedPieces
from engine.messages import JointState, RobotDescription, Wrench
from engine.messages.device_state import DeviceMode, DeviceState
from engine.skills.arm_control import ArmStatus

MAX_MESSAGES = 50_000
"""Messages of one topic that are read; of more, as many lie evenly among all."""
APART_S = 1.0
"""Samples beyond a limit that are no further apart are one excursion."""
POSITION_SHARE = 0.005
"""A joint is at its limit within this share of its range."""
SPEED_SHARE = 1.02
"""Motions are planned up to the speed limit; above this share of it, a joint is too fast."""
TORQUE_SHARE = 0.98
"""From this share of its torque limit on, a joint cannot follow."""
_READ = frozenset({JointState.__name__, Wrench.__name__, ArmStatus.__name__})
_STOPPED = frozenset({"reflex", "fault"})
_DEVICE_WORDS: dict[DeviceMode, str] = {
    "reading": "not enabled",
    "enabled": "enabled",
    "stopped": "stopped",
    "fault": "has a fault",
    "lost": "lost",
}
_MESSAGES_PER_YIELD = 256
SeqAt = Callable[[float], int]
_M = TypeVar("_M", bound=msgspec.Struct)


@dataclass(kw_only=True)
class _Excursion:
    """An interval in which a quantity was beyond a limit; `value` is the extreme, at `peak_s`."""

    from_s: float
    until_s: float
    peak_s: float
    value: float
    excess: float


@dataclass(kw_only=True)
class _Excursions:
    """The excursions of one quantity, from its samples in order."""

    found: list[_Excursion] = field(default_factory=list[_Excursion])

    def take(self, at_s: float, value: float, excess: float) -> None:
        """Take a sample; it is beyond the limit by `excess` if that is not negative."""
        if excess < 0.0 or math.isnan(excess):
            return
        last = self.found[-1] if self.found else None
        if last is None or at_s - last.until_s > APART_S:
            self.found.append(_Excursion(from_s=at_s, until_s=at_s, peak_s=at_s, value=value, excess=excess))
            return
        last.until_s = at_s
        if excess > last.excess:
            last.peak_s, last.value, last.excess = at_s, value, excess


@dataclass(frozen=True, kw_only=True)
class _Context:
    """What markers have in common: the goals of the run, and the events before a time."""

    goals: Sequence[PerformedGoal]
    seq_at: SeqAt

    def marker(
        self,
        kind: MeasuredKind,
        at_s: float,
        device: str,
        value: float | None,
        unit: str,
        limit: float | None,
        text: str,
    ) -> MeasuredMarker:
        active = (g for g in reversed(self.goals) if g.from_s <= at_s <= g.until_s and _is_of(g.device, device))
        path = next((goal.path for goal in active), "")
        seq = self.seq_at(at_s)
        return MeasuredMarker(
            kind=kind, seq=seq, time_s=at_s, path=path, device=device, value=value, unit=unit, limit=limit, text=text
        )


def telemetry_markers(pieces: RecordedPieces, goals: Sequence[PerformedGoal], seq_at: SeqAt) -> list[MeasuredMarker]:
    """Return the markers of all arms in a recording, arm by arm.

    Args:
        pieces: The open recordings.
        goals: The goals of the run; they name the node that was active, and the forces of guarded moves.
        seq_at: Returns the number of the last event up to a time.

    Raises:
        RecordingError: a recording is damaged.
    """
    context = _Context(goals=goals, seq_at=seq_at)
    topics = pieces.topics
    markers: list[MeasuredMarker] = []
    for topic, kind in sorted(topics.items()):
        arm = topic.rpartition("/")[0]
        if kind == RobotDescription.__name__ and f"{arm}/joint_state" in topics:
            markers += _of_joints(pieces, arm, context)
        elif kind == Wrench.__name__:
            markers += _of_forces(pieces, arm, topic, context)
        elif kind == ArmStatus.__name__:
            markers += _of_stops(pieces, arm, topic, context)
        elif kind == DeviceState.__name__:
            markers += _of_device(pieces, arm, topic, context)
    return markers


def read_every(pieces: RecordedPieces) -> int:
    """Return n, where every n-th message is read of the topic that has most."""
    counts = (pieces.count(topic) for topic, kind in pieces.topics.items() if kind in _READ)
    return max((-(-count // MAX_MESSAGES) for count in counts if count > 0), default=1)


def _of_joints(pieces: RecordedPieces, arm: str, context: _Context) -> Iterator[MeasuredMarker]:
    described = [message for _, message in _read(pieces, f"{arm}/description", RobotDescription)]
    if not described:
        return
    limits = described[-1]
    names = limits.joint_names
    tables = {what: [_Excursions() for _ in names] for what in ("lower", "upper", "speed", "torque")}
    for at_s, state in _read(pieces, f"{arm}/joint_state", JointState):
        if state.names != names:
            continue
        for row in range(len(names)):
            position, low, high = state.position_rad[row], limits.lower_rad[row], limits.upper_rad[row]
            if low < high and math.isfinite(margin := POSITION_SHARE * (high - low)):
                tables["lower"][row].take(at_s, position, low + margin - position)
                tables["upper"][row].take(at_s, position, position - high + margin)
            speed = abs(state.velocity_rad_s[row]) if row < len(state.velocity_rad_s) else math.nan
            tables["speed"][row].take(at_s, speed, speed - SPEED_SHARE * limits.velocity_rad_s[row])
            if row < len(limits.effort_nm) and row < len(state.effort_nm):
                torque = abs(state.effort_nm[row])
                tables["torque"][row].take(at_s, torque, torque - TORQUE_SHARE * limits.effort_nm[row])
    for row, name in enumerate(names):
        for end, limit in (("lower", limits.lower_rad[row]), ("upper", limits.upper_rad[row])):
            for each in tables[end][row].found:
                text = f"{arm}: {name} at its {end} limit"
                yield context.marker("limit", each.from_s, arm, each.value, "rad", limit, text)
        for each in tables["speed"][row].found:
            text = f"{arm}: {name} faster than its limit"
            yield context.marker("limit", each.peak_s, arm, each.value, "rad/s", limits.velocity_rad_s[row], text)
        for each in tables["torque"][row].found:
            text = f"{arm}: {name} at its torque limit"
            yield context.marker("limit", each.peak_s, arm, each.value, "Nm", limits.effort_nm[row], text)


def _of_forces(pieces: RecordedPieces, arm: str, topic: str, context: _Context) -> Iterator[MeasuredMarker]:
    """Yield the peaks of the external force above the threshold of the reflex, and in guarded moves."""
    statuses = list(_read(pieces, f"{arm}/status", ArmStatus)) if pieces.topics.get(f"{arm}/status") else []
    guarded = [goal for goal in context.goals if goal.device == arm and goal.force_n is not None]
    above: dict[tuple[str, float], _Excursions] = {}
    at_status = 0
    allowed_n: float | None = None
    for at_s, wrench in _read(pieces, topic, Wrench):
        while at_status < len(statuses) and statuses[at_status][0] <= at_s:
            allowed_n = statuses[at_status][1].settings.collision_force_n
            at_status += 1
        force_n = math.hypot(*wrench.force_n)
        asked_n = next((goal.force_n for goal in guarded if goal.from_s <= at_s <= goal.until_s), None)
        for limit, words in ((asked_n, "what was asked for"), (allowed_n, "the threshold of its reflex")):
            if limit is not None:
                above.setdefault((words, limit), _Excursions()).take(at_s, force_n, force_n - limit)
    for (words, limit), excursions in above.items():
        for each in excursions.found:
            text = f"{arm}: external force above {words}"
            yield context.marker("force", each.peak_s, arm, each.value, "N", limit, text)


def _of_stops(pieces: RecordedPieces, arm: str, topic: str, context: _Context) -> Iterator[MeasuredMarker]:
    """Yield the times at which an arm stopped by itself."""
    before = ""
    for at_s, status in _read(pieces, topic, ArmStatus):
        if status.mode in _STOPPED and before not in _STOPPED:
            force_n = math.hypot(*status.wrench.force_n)
            reason = status.error and f": {status.error}"
            text = f"{arm} stopped by itself ({status.mode}){reason}"
            yield context.marker("limit", at_s, arm, force_n, "N", status.settings.collision_force_n, text)
        before = status.mode


def _of_device(pieces: RecordedPieces, device: str, topic: str, context: _Context) -> Iterator[MeasuredMarker]:
    """Yield the times at which a real device was enabled, stopped or lost; not how it was at the beginning."""
    before: DeviceState | None = None
    for at_s, state in _read(pieces, topic, DeviceState):
        if before is not None and (state.mode, state.problem) != (before.mode, before.problem):
            if state.enabled:
                text = f"{device} enabled by {state.enabled_by or 'a person'}: {state.enabled_for}"
            else:
                text = f"{device} {_DEVICE_WORDS[state.mode]}: {state.problem}"
            yield context.marker("limit", at_s, device, None, "", None, text)
        before = state


def _read(pieces: RecordedPieces, topic: str, kind: type[_M]) -> Iterator[tuple[float, _M]]:
    decoder = msgspec.json.Decoder(kind)
    for count, (at_s, data) in enumerate(pieces.messages(topic, most=MAX_MESSAGES), 1):
        if count % _MESSAGES_PER_YIELD == 0:
            # Runs beside the engine's thread, which a long loop must not block.
            time.sleep(0)
        try:
            yield at_s, decoder.decode(data)
        except msgspec.DecodeError:
            continue  # of another device, or written by another version


def _is_of(device: str, arm: str) -> bool:
    return device == arm or device.startswith(f"{arm}/")
