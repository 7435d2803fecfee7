"""What is said of a name or value that does not fit, and of what would fit instead.

Each name is imported with its first use: names are suggested without a library for messages.
"""

from engine.lazy_face import lazy_face

_HOMES = {
    "did_you_mean": "engine.wording.suggestions",
    "explain_misfit": "engine.wording.misfit",
}

__all__ = list(_HOMES)  # pyright: ignore[reportUnsupportedDunderAll] - checkers read `__init__.pyi`
__getattr__ = lazy_face(__name__, _HOMES)
