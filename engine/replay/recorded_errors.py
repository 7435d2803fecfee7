"""Rebuilds the exceptions of a recorded run from their recorded causes."""

from __future__ import annotations

from engine import errors
from engine.errors import Cause, FlexcellError, SkillFailed


def error_from_cause(cause: Cause) -> FlexcellError:
    """Return an error with the same cause, except for positions in code files."""
    found: object = getattr(errors, cause.kind, None)
    kind = found if isinstance(found, type) and issubclass(found, FlexcellError) else _kind(cause.kind)
    error = kind(cause.message, where=cause.where or None)
    error.nodes = cause.nodes
    if cause.because is not None:
        error.__cause__ = _reason(cause.because)
    return error


def _reason(cause: Cause) -> BaseException:
    found: object = getattr(errors, cause.kind, None)
    if isinstance(found, type) and issubclass(found, FlexcellError):
        return error_from_cause(cause)
    # An exception of another package: only its name and its text are recorded.
    error = type(cause.kind or "Exception", (Exception,), {})(cause.message)
    if cause.because is not None:
        error.__cause__ = _reason(cause.because)
    return error


def _kind(name: str) -> type[FlexcellError]:
    """Return a class of this name for an error of a package that is not loaded here."""
    return type(name, (SkillFailed,), {}) if name.isidentifier() else SkillFailed
