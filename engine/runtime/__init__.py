"""Executes behaviors: plans, runs, their nodes and trees, operator control, resume and hot change.

A state asks for the format of a message and the check for a plan, so each name is imported with its first use.
"""

from engine.lazy_face import lazy_face

_HOMES = {
    "Run": "engine.runtime.run",
    "RunOptions": "engine.runtime.run_options",
    "RunResult": "engine.runtime.run_result",
    "Supervision": "engine.runtime.run_options",
    "decode_nonfinite": "engine.runtime.record.nonfinite",
}

__all__ = list(_HOMES)  # pyright: ignore[reportUnsupportedDunderAll] - checkers read `__init__.pyi`
__getattr__ = lazy_face(__name__, _HOMES)
