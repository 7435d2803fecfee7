"""Checks from pads, opening and force whether a gripper holds the commanded object, or states why not."""

from __future__ import annotations

from dataclasses import dataclass

from engine.messages import HoldEvidence
from engine.skills.part_label import UNKNOWN_BODY, hold_evidence
from robots.port.gripper import GripperSample

# In motion the pad force oscillates about the commanded one.
FORCE_SHARE = 0.5
_UNDETECTED = {
    True: "the sensor of the gripper detects no part",
    False: "nothing measures whether the gripper holds a part",
}


@dataclass(frozen=True, kw_only=True)
class GraspCommand:
    """A grasp command: minimum and maximum opening, metres, and the force, newton."""

    least_m: float
    most_m: float
    force_n: float


def check_grasp(sample: GripperSample, grip: GraspCommand) -> str:
    """Return why nothing is held; empty if something is."""
    left, right = sample.contacts
    if sample.evidence != "width":
        return "" if left and right else _UNDETECTED[sample.evidence == "sensor"]
    width = _millimetres(sample.width_m)
    if not left and not right:
        return f"fingers closed to {width} and touch nothing"
    if not left or not right:
        side, body = ("left", left) if left else ("right", right)
        return f"only the {side} pad touches {_name(body)}, fingers at {width}"
    if left != right and UNKNOWN_BODY not in (left, right):
        return f"the pads touch different things, {left} and {right}"
    if not grip.least_m <= sample.width_m <= grip.most_m:
        bounds = f"{_millimetres(grip.least_m)} to {_millimetres(grip.most_m)}"
        return f"the fingers stopped at {width} on {_name(left)}, expected {bounds}"
    if sample.force_n < FORCE_SHARE * grip.force_n:
        return f"the pads press with {sample.force_n:.1f} N on {_name(left)}, expected {grip.force_n:.1f} N"
    return ""


def held_part(sample: GripperSample) -> str:
    """Return the name of what both pads press on, `?` where neither can tell."""
    return next((body for body in sample.contacts if body and body != UNKNOWN_BODY), UNKNOWN_BODY)


def grasp_evidence(sample: GripperSample) -> HoldEvidence:
    """Return what tells whether and what a gripper holds."""
    return hold_evidence(*sample.contacts, otherwise=sample.evidence)


def _name(body: str) -> str:
    return "something" if body == UNKNOWN_BODY else body


def _millimetres(length_m: float) -> str:
    # Pads yield a little under force: an opening just below zero is closed.
    return f"{max(0.0, length_m) * 1e3:.1f} mm"
