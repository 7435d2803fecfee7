# The face of this room for type checkers; `tests/house/test_python_face.py` compares it with what is imported.

from engine.runtime.record.nonfinite import decode_nonfinite
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions, Supervision
from engine.runtime.run_result import RunResult

__all__ = [
    "Run",
    "RunOptions",
    "RunResult",
    "Supervision",
    "decode_nonfinite",
]
