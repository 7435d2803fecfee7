"""Checks from switch state and pull whether a magnet holds something, or states why not."""

from __future__ import annotations

from engine.messages import HoldEvidence
from engine.skills.part_label import UNKNOWN_BODY, hold_evidence
from robots.magnet.magnet_port import MagnetSample
from robots.magnet.magnet_skills import MagnetState

# An object pulled with less than this share of the magnet's force touches by an edge or is not ferrous.
_HOLDS_SHARE = 0.05


def check_magnet_grasp(sample: MagnetSample, *, max_force_n: float) -> str:
    """Return why nothing is held; empty if something is."""
    if not sample.on:
        return "the magnet is switched off"
    if not sample.contact and sample.evidence == "sensor":
        return "the sensor of the magnet detects no part"
    if not sample.contact and sample.evidence == "not measured":
        return "nothing measures whether the magnet holds a part"
    if not sample.contact:
        return "the magnet is on and touches nothing"
    if sample.pull_n < _HOLDS_SHARE * max_force_n:
        touched = "something" if sample.contact == UNKNOWN_BODY else sample.contact
        return f"the magnet touches {touched} and pulls at it with {sample.pull_n:.1f} N of {max_force_n:.0f} N"
    return ""


def magnet_evidence(sample: MagnetSample) -> HoldEvidence:
    """Return what tells whether and what a magnet holds."""
    return hold_evidence(sample.contact, otherwise=sample.evidence)


def magnet_state(sample: MagnetSample, *, max_force_n: float) -> MagnetState:
    """Return the state of a magnet in a measurement, with its grasp re-evaluated."""
    held = not check_magnet_grasp(sample, max_force_n=max_force_n)
    return MagnetState(
        time_s=sample.time_s,
        on=sample.on,
        pull_n=sample.pull_n,
        held=held,
        part=sample.contact if held else "",
        by=magnet_evidence(sample),
    )
