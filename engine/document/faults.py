"""Fault documents: faults injected into requests of a run, to test how a behavior handles them.

    flexcell: 1
    faults:
      - {at: root/*/grasp, address: left/gripper/*, request: 1, error: the fingers are blocked}
      - {at: root/**, address: left/*, probability: 0.1, late: 500 ms}

A request of a state is a service call, an action goal, or the read of a topic. Only the first fault in the
document that matches a request is applied to it.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from msgspec import Meta

from engine.document.duration import Duration, seconds
from engine.document.path_pattern import PathPattern
from engine.document.text.decoding import StrictModel, decode_document
from engine.document.text.document_file import DocumentFile
from engine.document.text.yaml_source import DocumentSource, load_source, parse_source
from engine.errors import DocumentError, Position
from engine.skills.device_moves import DeviceFault

FaultKind = Literal["late", "hang", "error", "duplicate", "lost", "crash", "device"]
FAULT_KINDS: tuple[FaultKind, ...] = ("late", "hang", "error", "duplicate", "lost", "crash", "device")
_WHERE_AND_WHEN = ("at", "address", "request", "times", "probability")

AddressPattern = Annotated[
    str,
    Meta(
        min_length=1,
        description="A bus address or topic, for example `left/gripper/*`; wildcards as in `at`",
    ),
]


class HangFault(StrictModel, frozen=True, kw_only=True):
    """The device accepts the request and never responds.

    A cancel is delivered and confirmed, unless `ignore_cancel` is set.
    """

    ignore_cancel: bool = False


class ErrorFault(StrictModel, frozen=True, kw_only=True):
    """The request fails with `message`.

    `by` selects how: `abort` ends the goal as aborted, `reject` rejects it, `raise` raises in the
    state; services and topics always raise. Without `after` the device never receives the request; an
    aborted goal with `after` runs for that time and is then stopped.
    """

    message: Annotated[str, Meta(min_length=1, description="Error message of the failure")]
    by: Literal["abort", "reject", "raise"] = "abort"
    after: Duration = 0.0

    @property
    def after_s(self) -> float:
        """Time until the failure, in seconds."""
        return seconds(self.after)


class CrashFault(StrictModel, frozen=True, kw_only=True):
    """The process is killed immediately, as by `kill -9`.

    `at_event`: when the event with this number is recorded; `on_request`: before a matching request
    is sent, or after its effect and before its response is recorded.
    """

    at_event: Annotated[int, Meta(ge=1, description="Number of an event, from 1")] | None = None
    on_request: Literal["before", "after"] | None = None


class Fault(StrictModel, frozen=True, kw_only=True):
    """One fault: exactly one kind, and the requests that it applies to.

    `request` is the n-th request of one state that `at` and `address` match, counted over all its
    activations. `times` limits how often the fault is applied in a run. `probability` is sampled for
    each such request from the seed of the run, the state and the number of the request, so that
    parallel branches are independent.

    `late` delays the response. `duplicate` delivers the request twice, with the same goal id: the
    copy follows `at_once` or `after_end` of the original, whose response is used; the message of a
    topic is read twice. With `lost` the `request` never reaches the device, or the device executes it
    and its `answer` is lost; of a topic one message is lost.
    """

    name: str = ""
    at: PathPattern = "**"
    address: AddressPattern = "**"
    request: Annotated[int, Meta(ge=1, description="The n-th matching request of a state, from 1")] | None = None
    times: Annotated[int, Meta(ge=1, description="Maximum number of applications, 1 or more")] | None = None
    probability: Annotated[float, Meta(gt=0.0, le=1.0, description="Above 0, at most 1")] = 1.0
    late: Duration | None = None
    hang: HangFault | None = None
    error: ErrorFault | Annotated[str, Meta(min_length=1, description="Error message of the failure")] | None = None
    duplicate: Literal["at_once", "after_end"] | None = None
    lost: Literal["request", "answer"] | None = None
    crash: CrashFault | None = None
    device: DeviceFault | None = None

    @property
    def kinds(self) -> tuple[FaultKind, ...]:
        """All kinds of the fault; a valid fault has one."""
        return tuple(kind for kind in FAULT_KINDS if getattr(self, kind) is not None)

    @property
    def kind(self) -> FaultKind:
        """The kind of the fault."""
        return self.kinds[0]

    @property
    def late_s(self) -> float:
        """The delay in seconds."""
        return seconds(self.late or 0.0)

    @property
    def failure(self) -> ErrorFault | None:
        """The error fault, also if only its message is written; None for other kinds."""
        return ErrorFault(message=self.error) if isinstance(self.error, str) else self.error

    @property
    def crashes_at(self) -> int | None:
        """The number of the event at which it kills the process; None for other faults."""
        return self.crash.at_event if self.crash is not None else None


_PLAIN = Fault()


class FaultsDocument(StrictModel, frozen=True, kw_only=True):
    """The faults of a run as written, in order of precedence."""

    flexcell: Literal[1]
    description: str = ""
    faults: Annotated[tuple[Fault, ...], Meta(min_length=1, description="The faults, at least one")]


@dataclass(frozen=True, kw_only=True)
class Faults(DocumentFile[FaultsDocument]):
    """A fault document with its file."""

    def position(self, index: int) -> Position:
        """Return the position of the fault with this index, from 0."""
        return self.source.position(("faults", index))


def load_faults(path: Path | str) -> Faults:
    """Read a fault document.

    Raises:
        DocumentError: the file cannot be read or is not valid; `where` is the position.
    """
    return _checked(load_source(Path(path)), Path(path))


def parse_faults(text: bytes | str, *, file: Path | str) -> Faults:
    """Return the faults that `text` describes; `file` is the name shown in positions.

    Raises:
        DocumentError: as `load_faults`.
    """
    return _checked(parse_source(text, file=str(file)), Path(file))


def _checked(source: DocumentSource, file: Path) -> Faults:
    document = decode_document(source, FaultsDocument)
    for index, fault in enumerate(document.faults):
        _require_one_kind(source, index, fault)
        if fault.crash is not None:
            _require_one_crash(source, index, fault, fault.crash)
    return Faults(document=document, file=file, source=source)


def _require_one_kind(source: DocumentSource, index: int, fault: Fault) -> None:
    known = ", ".join(f"`{kind}`" for kind in FAULT_KINDS)
    if not fault.kinds:
        where = source.position(("faults", index))
        raise DocumentError("this fault has no kind", where=where, hint=f"add one of {known}")
    if len(fault.kinds) > 1:
        where = source.position(("faults", index, fault.kinds[1]), of_key=True)
        raise DocumentError(
            f"this fault has both `{fault.kinds[0]}` and `{fault.kinds[1]}`",
            where=where,
            hint="split it into two faults",
        )


def _require_one_crash(source: DocumentSource, index: int, fault: Fault, crash: CrashFault) -> None:
    where = source.position(("faults", index, "crash"), of_key=True)
    if (crash.at_event is None) == (crash.on_request is None):
        raise DocumentError("a crash has either `at_event` or `on_request`", where=where, hint="set one of them")
    if crash.at_event is None:
        return
    for key in _WHERE_AND_WHEN:
        if getattr(fault, key) != getattr(_PLAIN, key):
            place = source.position(("faults", index, key), of_key=True)
            raise DocumentError(f"`{key}` has no effect with `at_event`", where=place, hint=f"remove `{key}`")
