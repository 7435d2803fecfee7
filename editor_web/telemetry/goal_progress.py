"""Progress of the goals of a run, by the node that sent them, from the latest feedback."""

from __future__ import annotations

import math

import msgspec

from editor_web.telemetry.data_frames import GoalProgress
from editor_web.telemetry.plot_signals import unit_of
from engine.project import GoalInfo

_REST = ("remaining", "distance")
_TEXT_FIELDS = ("phase", "reason")


def progress_by_node(goals: tuple[GoalInfo, ...]) -> dict[str, GoalProgress]:
    """Return the active goal of each node; the latest one if it has several."""
    return {
        goal.node: GoalProgress(
            address=goal.address, status=goal.status, share=_share(goal.feedback), words=_feedback_text(goal.feedback)
        )
        for goal in goals
    }


def _share(feedback: object) -> float | None:
    share = getattr(feedback, "progress", None)
    if not isinstance(share, int | float) or not math.isfinite(share):
        return None
    return round(min(1.0, max(0.0, float(share))), 3)


def _feedback_text(feedback: object) -> str:
    """Return the phase and reason of a feedback, else the remaining amount, else its first number; short."""
    if not isinstance(feedback, msgspec.Struct):
        return ""
    texts = [str(getattr(feedback, name)) for name in _TEXT_FIELDS if getattr(feedback, name, "")]
    if texts:
        return ", ".join(texts)[:80]
    numbers = {name: value for name in feedback.__struct_fields__ if (value := _number(feedback, name)) is not None}
    numbers.pop("progress", None)
    rest = [name for name in numbers if name.startswith(_REST)]
    for name in [*rest, *numbers][:1]:
        return _number_text(name, numbers[name])
    return ""


def _number(feedback: msgspec.Struct, name: str) -> float | None:
    value: object = getattr(feedback, name)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        return None
    return float(value)


def _number_text(name: str, value: float) -> str:
    unit = unit_of(name)
    if not unit:
        return f"{name.replace('_', ' ')} {value:.3g}"
    bare = "_".join(name.split("_")[: -unit.count("/") - 1]).replace("_", " ")
    return f"{bare} {value * 1000:.1f} mm" if unit == "m" and abs(value) < 1 else f"{bare} {value:.3g} {unit}"
