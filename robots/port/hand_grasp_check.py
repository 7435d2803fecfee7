"""Checks from the contacts of thumb, fingers and palm whether a hand holds something, or states why not."""

from __future__ import annotations

from dataclasses import dataclass

from engine.messages import HandState, HoldEvidence
from engine.skills.part_label import UNKNOWN_BODY, hold_evidence
from robots.port.hand import HandSample

_OPEN_SHARE = 0.01
# Fingers that merely touch take hardly more force than closing on nothing.
_PRESSES_SHARE = 0.03


@dataclass(frozen=True, kw_only=True)
class HandGrasp:
    """The held body: its name, `?` for unknown, empty for nothing; then `reason` states why."""

    part: str = ""
    reason: str = ""


def check_hand_grasp(sample: HandSample, *, max_force_n: float) -> HandGrasp:
    """Return what a hand holds: what at least one finger presses against the thumb or the palm."""
    closed = f"{100.0 * sample.closed_share:.0f} %"
    if sample.closed_share <= _OPEN_SHARE:
        return HandGrasp(reason="the hand is open")
    if not any(sample.contacts):
        return HandGrasp(reason=f"the hand closed to {closed} and touches nothing")
    thumb, *fingers, palm = sample.contacts
    known = tuple(dict.fromkeys(body for body in sample.contacts if body and body != UNKNOWN_BODY))
    words = " and ".join(known) or "something"
    if not any(fingers):
        return HandGrasp(reason=f"only {'the thumb' if thumb else 'the palm'} touches {words}, at {closed}")
    if sample.force_n < _PRESSES_SHARE * max_force_n:
        return HandGrasp(reason=f"the hand touches {words} at {closed} and presses with {sample.force_n:.1f} N only")
    for body in known or (UNKNOWN_BODY,):
        meant = (body, UNKNOWN_BODY)
        if (thumb in meant or palm in meant) and any(finger in meant for finger in fingers):
            return HandGrasp(part=body)
    return HandGrasp(reason=f"the fingers touch {words} at {closed}, but neither thumb nor palm opposes them")


def hand_evidence(sample: HandSample) -> HoldEvidence:
    """Return what tells whether and what a hand holds."""
    return hold_evidence(*sample.contacts, otherwise="current")


def hand_state(sample: HandSample, *, max_force_n: float) -> HandState:
    """Return the state of a hand in a measurement, with its grasp re-evaluated."""
    part = check_hand_grasp(sample, max_force_n=max_force_n).part
    return HandState(
        time_s=sample.time_s,
        closed_percent=100.0 * sample.closed_share,
        force_n=sample.force_n,
        held=bool(part),
        part=part,
        by=hand_evidence(sample),
    )
