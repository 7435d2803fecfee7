"""How far the goals of a run are, by the node that sent them, from the newest feedback of each."""

from __future__ import annotations

import math

import msgspec

from editor_web.telemetry.data_frames import GoalProgress
from editor_web.telemetry.plot_signals import unit_of
from engine.project.bus_inspector import GoalInfo

_REST = ("remaining", "distance")
_WORDS = ("phase", "reason")


def progress_by_node(goals: tuple[GoalInfo, ...]) -> dict[str, GoalProgress]:
    """Return the goal that each node has under way; the newest one where it has several."""
    return {
        goal.node: GoalProgress(
            address=goal.address, status=goal.status, share=_share(goal.feedback), words=_words(goal.feedback)
        )
        for goal in goals
    }


def _share(feedback: object) -> float | None:
    share = getattr(feedback, "progress", None)
    if not isinstance(share, int | float) or not math.isfinite(share):
        return None
    return round(min(1.0, max(0.0, float(share))), 3)


def _words(feedback: object) -> str:
    """The phase and reason that a feedback tells, else what remains, else its first number; short."""
    if not isinstance(feedback, msgspec.Struct):
        return ""
    told = [str(getattr(feedback, name)) for name in _WORDS if getattr(feedback, name, "")]
    if told:
        return ", ".join(told)[:80]
    numbers = {name: value for name in feedback.__struct_fields__ if (value := _number(feedback, name)) is not None}
    numbers.pop("progress", None)
    rest = [name for name in numbers if name.startswith(_REST)]
    for name in [*rest, *numbers][:1]:
        return _in_words(name, numbers[name])
    return ""


def _number(feedback: msgspec.Struct, name: str) -> float | None:
    value: object = getattr(feedback, name)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        return None
    return float(value)


def _in_words(name: str, value: float) -> str:
    unit = unit_of(name)
    if not unit:
        return f"{name.replace('_', ' ')} {value:.3g}"
    bare = "_".join(name.split("_")[: -unit.count("/") - 1]).replace("_", " ")
    return f"{bare} {value * 1000:.1f} mm" if unit == "m" and abs(value) < 1 else f"{bare} {value:.3g} {unit}"
