"""Measures of arms: how samples of one become sums, and what topics tell of arms that no simulated world measures.

`ArmSums` is the one place where path, speed, lag and force of an arm are summed up. Simulated worlds use it too and
need no bus: each name is imported with its first use. `TopicMeasures` reads topics of a bus or of a recording.
"""

from engine.lazy_face import lazy_face

_HOMES = {
    "ARM_MEASURES": "engine.measures.arm_sums",
    "ArmSums": "engine.measures.arm_sums",
    "TopicMeasures": "engine.measures.topic_measures",
}

__all__ = list(_HOMES)  # pyright: ignore[reportUnsupportedDunderAll] - checkers read `__init__.pyi`
__getattr__ = lazy_face(__name__, _HOMES)
