"""The errors of the project, each with what failed, where, and what to do; and the causes that events have of them."""

from __future__ import annotations

import msgspec

CONNECT_AGAIN = "connect the cell again: `flexcell cell connect`, or Connect on the page"
"""The hint for a lost device."""


class Position(msgspec.Struct, frozen=True, kw_only=True, gc=False):
    """A position in a source file; lines and columns count from 1."""

    file: str
    line: int
    column: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


class FlexcellError(Exception):
    """Base of all errors that this project raises on purpose.

    Args:
        message: What happened, in one line.
        where: The file position, node path, device or frame of the error.
        hint: What to do about it.
    """

    def __init__(self, message: str, *, where: object | None = None, hint: str | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.where = where
        self.hint = hint
        self.nodes: tuple[str, ...] = ()
        """The nodes of the behavior that the error passed through, `path at file:line:column`, innermost first."""

    @property
    def statement(self) -> str:
        """Where and what, for an error that passes the hint on as its own."""
        return f"{self.where}: {self.message}" if self.where is not None else self.message

    def __str__(self) -> str:
        advice = f" ({self.hint})" if self.hint else ""
        return f"{self.statement}{advice}"


class DocumentError(FlexcellError):
    """A behavior, cell or entries document cannot be used; `where` is a `Position`."""

    others: tuple[DocumentError, ...] = ()
    """The other errors of the same document, when this is the first of several."""


class ExpressionError(FlexcellError):
    """A `${…}` expression does not compile, or failed when evaluated."""


class UserdataError(FlexcellError):
    """A state read or wrote a key that it does not declare or that is not defined."""


class StateError(FlexcellError):
    """A state broke its contract or raised; `where` is the node path."""


class NotStopped(StateError):
    """A node did not stop in time and was abandoned; the resources that it commands stay leased."""


class ControlError(FlexcellError):
    """A command of the operator cannot be executed; nothing has changed."""


class RegistryError(FlexcellError):
    """A name does not resolve to a state, robot or store."""


class ModuleNotAllowed(RegistryError):
    """A document names a class of a module that the project does not allow; the module was not imported."""


class BusError(FlexcellError):
    """Base of all errors of the skill bus."""


class HandlerNotTyped(BusError):
    """A handler without complete annotations was offered to the bus."""


class NoSuchSkill(BusError):
    """No skill is registered at this bus address."""


class LeaseRefused(BusError):
    """A resource is leased by another holder; the message names it."""


class GoalRejected(BusError):
    """An action server rejected a goal before executing it."""


class SkillFailed(BusError):
    """A skill was accepted and failed; `result` is its partial result, as in `GoalEnd`."""

    result: object | None = None


class StoreError(FlexcellError):
    """A store refused a request, is damaged, or cannot be accessed."""


class EntryNotFound(StoreError):
    """No entry has this kind and name."""


class EntryConflict(StoreError):
    """The stored entry has another revision than the writer expected; the message says which."""


class JournalError(FlexcellError):
    """The journal cannot be written; the run must stop."""


class RecordingError(FlexcellError):
    """A recording cannot be started, read or replayed; `where` is the file."""


class CellError(FlexcellError):
    """A cell document names an element that cannot be built or connected."""


class RobotError(FlexcellError):
    """A robot or device reported a fault or lost its connection."""


class PathBlocked(RobotError):
    """An obstacle of the planning scene blocks the path of a motion without replanning; the message names both."""


class MeasuredValue(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True, gc=False):
    """A measured number of a failure, in `unit`, and what was expected: from `least` to `most`, null for no limit."""

    quantity: str
    measured: float
    unit: str
    least: float | None = None
    most: float | None = None


class CauseLink(msgspec.Struct, frozen=True, kw_only=True):
    """One link of the cause chain of a failure; those of a whole chain are in order, root cause first."""

    message: str
    where: str = ""
    kind: str = ""
    compared: tuple[MeasuredValue, ...] = ()


class CauseLine(CauseLink, frozen=True, kw_only=True):
    """One link as logs show it; `skill` is the skill at the address `where` in words, empty if that is no address."""

    skill: str = ""


class Cause(CauseLink, frozen=True, kw_only=True, omit_defaults=True):
    """One link with the rest of its chain; `because` is the next link towards the root cause.

    `nodes` are the nodes that an error passed through, `path at file:line:column`, innermost first.
    """

    because: Cause | None = None
    nodes: tuple[str, ...] = ()

    def chain(self) -> tuple[Cause, ...]:
        """Return the links from the outermost to the root cause."""
        links: list[Cause] = []
        link: Cause | None = self
        while link is not None:
            links.append(link)
            link = link.because
        return tuple(links)
