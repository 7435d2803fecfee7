# The face of this room for type checkers; `tests/house/test_python_face.py` compares it with what is imported.

from engine.measures.arm_sums import ARM_MEASURES, ArmSums
from engine.measures.topic_measures import TopicMeasures

__all__ = [
    "ARM_MEASURES",
    "ArmSums",
    "TopicMeasures",
]
