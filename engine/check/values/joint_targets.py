"""Checks that commanded joint angles match the number of joints and the joint limits of the arm in the cell."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import cast

from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt
from engine.check.finding import Finding
from engine.check.values.annotated_values import annotated_lists, is_annotated
from engine.check.values.known_values import known_part
from engine.check.values.magnitude import MOST_TURNS_RAD
from engine.document.signature import StateSignature

JointRanges = Mapping[str, tuple[tuple[float, float], ...]]
"""Minimum and maximum angle of each joint in radians, by robot name."""
_NEARLY_RAD = 1e-6


def check_joint_targets(
    subject: AnalyzedBehavior, ranges: JointRanges, known: Mapping[str, object]
) -> Iterator[Finding]:
    """Find joint angles in a behavior that violate the joint limits or joint count of their arm.

    Args:
        subject: The behavior.
        ranges: The joint ranges of the robots whose models are known.
        known: Parameters of the behavior by name.
    """
    for placed in subject.nodes.values():
        signature = subject.signature(placed.node)
        if signature is not None:
            yield from _check_state(subject, placed, signature, ranges, known)


def _check_state(
    subject: AnalyzedBehavior,
    placed: NodeAt,
    signature: StateSignature,
    ranges: JointRanges,
    known: Mapping[str, object],
) -> Iterator[Finding]:
    given = placed.given
    for name, found in given.items():
        declared = signature.parameters.get(name)
        if declared is None or not is_annotated(declared.type):
            continue
        for steps, listed in annotated_lists(declared.type, known_part(found, known)):
            of = listed[0].says.get("joints_of")
            robot = known_part(given[str(of)], known) if of in given else None
            angles = [each.value for each in listed]
            if (
                not isinstance(robot, str)
                or robot not in ranges
                or not all(isinstance(each, int | float) for each in angles)
            ):
                continue
            fault = _fault(robot, ranges[robot], cast("list[float]", angles))
            if fault is not None:
                index, message, hint = fault
                keys = ("with", name, *steps, *(() if index is None else (index,)))
                yield subject.finding(
                    "unreachable-joints", f"`{_label(name, steps)}`: {message}", placed.path, *keys, hint=hint
                )


def _label(name: str, steps: tuple[str | int, ...]) -> str:
    """Return the name of a value inside a parameter, such as `waypoints[1].joints`."""
    return name + "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in steps)


def _fault(
    robot: str, ranges: tuple[tuple[float, float], ...], angles: list[float]
) -> tuple[int | None, str, str] | None:
    """Return the index of the wrong joint (None for the whole list), the message and the hint."""
    if len(angles) != len(ranges):
        return (
            None,
            f"`{robot}` has {len(ranges)} joints, not {len(angles)}",
            "write one angle in radians for each joint",
        )
    if max(map(abs, angles)) > MOST_TURNS_RAD:
        return None  # reported as degrees by `check_magnitudes`
    for index, (angle, (low, high)) in enumerate(zip(angles, ranges, strict=True)):
        if not low - _NEARLY_RAD <= angle <= high + _NEARLY_RAD:
            message = f"joint {index + 1} of `{robot}`: {angle:g} rad is outside the joint limits"
            return index, message, f"the limits are {low:.4g} to {high:.4g} rad"
    return None
