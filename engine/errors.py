"""The one family of errors: each says what failed, where, and what the reader can do."""

from __future__ import annotations

import msgspec

CONNECT_AGAIN = "connect the cell again: `flexcell cell connect`, or Connect on the page"
"""What to do about a lost device."""


class Position(msgspec.Struct, frozen=True, kw_only=True, gc=False):
    """A place in a source file; lines and columns count from 1."""

    file: str
    line: int
    column: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


class FlexcellError(Exception):
    """Root of every error this project raises on purpose.

    Args:
        message: What happened, in one line.
        where: The file position, node path, device or frame it is about.
        hint: What the reader can do about it.
    """

    def __init__(self, message: str, *, where: object | None = None, hint: str | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.where = where
        self.hint = hint
        self.nodes: tuple[str, ...] = ()
        """The nodes of a behavior that it came through, `path at file:line:column`, innermost first."""

    def __str__(self) -> str:
        place = f"{self.where}: " if self.where is not None else ""
        advice = f" ({self.hint})" if self.hint else ""
        return f"{place}{self.message}{advice}"


class DocumentError(FlexcellError):
    """A behavior, cell or entries document cannot be used; `where` is a `Position`."""

    others: tuple[DocumentError, ...] = ()
    """The other mistakes of the same document, where this is the first of several."""


class ExpressionError(FlexcellError):
    """A `${…}` expression does not compile, or failed when evaluated."""


class UserdataError(FlexcellError):
    """A state read or wrote a key that it does not declare or that is not defined."""


class StateError(FlexcellError):
    """A state broke its contract or raised; `where` is the node path."""


class NotStopped(StateError):
    """A node was told to stop and has not in time; it was abandoned, and what it commands stays leased."""


class ControlError(FlexcellError):
    """A command of the operator cannot be carried out; nothing has changed."""


class RegistryError(FlexcellError):
    """A name resolves to no state, robot or store."""


class ModuleNotAllowed(RegistryError):
    """A document names a class of a module that the project does not allow; nothing was imported."""


class BusError(FlexcellError):
    """Root of everything the skill bus refuses."""


class HandlerNotTyped(BusError):
    """A handler without complete annotations was offered to the bus."""


class NoSuchSkill(BusError):
    """No skill is registered at this bus address."""


class LeaseRefused(BusError):
    """A resource is held by somebody else; the message names the holder."""


class GoalRejected(BusError):
    """An action server refused a goal before executing any of it."""


class SkillFailed(BusError):
    """A skill was accepted and could not be carried out; `result` is what it says all the same, as in `GoalEnd`."""

    result: object | None = None


class StoreError(FlexcellError):
    """The store refused or lost something."""


class EntryNotFound(StoreError):
    """No entry has this kind and name."""


class EntryConflict(StoreError):
    """The stored entry has another revision than the writer expected; the message says which."""


class JournalError(FlexcellError):
    """The journal cannot be written; the run must stop."""


class RecordingError(FlexcellError):
    """A recording cannot be begun, read or replayed; `where` is the file."""


class CellError(FlexcellError):
    """A cell document names something that cannot be built or connected."""


class RobotError(FlexcellError):
    """A robot or device reported a fault or lost its connection."""


class PathBlocked(RobotError):
    """Something of the planning scene is in the way of a motion that looks for no other; the message names both."""
