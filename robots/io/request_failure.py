"""The answer of a worker process to a request that it cannot carry out."""

from __future__ import annotations

import msgspec

from engine.errors import CellError, FlexcellError


class RequestFailure(msgspec.Struct, frozen=True, kw_only=True, tag="failed"):
    """A cell, scene, model or request is invalid; the process works on."""

    message: str
    where: str = ""
    hint: str = ""

    @classmethod
    def of(cls, error: Exception) -> RequestFailure:
        """Return the failure that an error reports."""
        if not isinstance(error, FlexcellError):
            return cls(message=str(error))
        where = str(error.where) if error.where is not None else ""
        return cls(message=error.message, where=where, hint=error.hint or "")

    def error(self) -> CellError:
        """Return the error for whoever asked."""
        return CellError(self.message, where=self.where or None, hint=self.hint or None)
