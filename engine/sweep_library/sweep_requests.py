"""What the server asks a sweep process, and its answers; a line of JSON each."""

from __future__ import annotations

from typing import Literal

import msgspec

from engine.document.sweep import SweepDocument
from engine.sweep.shrinking import SameAs, ShrinkProgress
from engine.sweep_library.shrink_view import ShrunkTrial
from engine.sweep_library.sweep_view import SweepLive

CODE = "import sys; from engine.sweep_library.sweep_process import main; main(int(sys.argv[1]))"
"""The program of a sweep process; its argument is the number of its socket, the first line there is the project."""
RefusalKind = Literal["missing", "state", "invalid"]
"""There is no such thing; the state of the cell or sweep does not allow it; or the request is not valid."""


class ListSweeps(msgspec.Struct, frozen=True, kw_only=True, tag=True):
    """All sweeps of the project: a `SweepList`."""


class ReadSweep(msgspec.Struct, frozen=True, kw_only=True, tag=True):
    """A sweep with what it has shown: a `SweepView`."""

    sweep: str


class ReadRuns(msgspec.Struct, frozen=True, kw_only=True, tag=True):
    """The runs of a sweep: `SweepRuns`."""

    sweep: str


class ReadTrial(msgspec.Struct, frozen=True, kw_only=True, tag=True):
    """One run of a sweep: a `TrialResult`."""

    sweep: str
    number: int


class OfferFactors(msgspec.Struct, frozen=True, kw_only=True, tag=True):
    """What a sweep of a behavior can vary: a list of `FactorChoice`."""

    behavior: str


class CreateSweep(msgspec.Struct, frozen=True, kw_only=True, tag=True):
    """Write a sweep document, whose paths are relative to the project: its path."""

    sweep: str
    document: SweepDocument


class ExecuteSweep(msgspec.Struct, frozen=True, kw_only=True, tag=True):
    """Execute what is left of a sweep: a `SweepLive` now and then, and one at the end."""

    sweep: str
    again: bool = False


class RecordTrial(msgspec.Struct, frozen=True, kw_only=True, tag=True):
    """Execute a run of a sweep again and record it: a `RecordedTrial`."""

    sweep: str
    number: int


class ShrinkTrial(msgspec.Struct, frozen=True, kw_only=True, tag=True):
    """Shrink a failing run of a sweep: a `ShrinkProgress` after each run, and a `ShrunkTrial` at the end."""

    sweep: str
    number: int
    same: SameAs = "outcome"


class SaveCase(msgspec.Struct, frozen=True, kw_only=True, tag=True):
    """Write a run that was shrunk as a test case to `case`, a path in the project: that path."""

    sweep: str
    case: str
    found: ShrunkTrial


class FindBaselines(msgspec.Struct, frozen=True, kw_only=True, tag=True):
    """What a sweep can be compared with: a list of `Baseline`."""

    sweep: str


class CompareSweep(msgspec.Struct, frozen=True, kw_only=True, tag=True):
    """Compare a sweep with a baseline: a `SweepComparison`."""

    sweep: str
    results: str
    version: str
    margin: float | None = None


SweepRequest = (
    ListSweeps
    | ReadSweep
    | ReadRuns
    | ReadTrial
    | OfferFactors
    | CreateSweep
    | ExecuteSweep
    | RecordTrial
    | ShrinkTrial
    | SaveCase
    | FindBaselines
    | CompareSweep
)


class Answered(msgspec.Struct, frozen=True, kw_only=True, tag=True):
    """The answer, as the JSON that the page gets."""

    body: msgspec.Raw


class Refused(msgspec.Struct, frozen=True, kw_only=True, tag=True):
    """Why there is none."""

    kind: RefusalKind
    words: tuple[str, str, str]
    """The message of the error, where it is, and its hint."""


class Proceeding(msgspec.Struct, frozen=True, kw_only=True, tag=True):
    """How far an execution is, before its answer."""

    live: SweepLive


class ShrinkProceeding(msgspec.Struct, frozen=True, kw_only=True, tag=True):
    """How far a run is shrunk, before its answer."""

    progress: ShrinkProgress


SweepProgressAnswer = Proceeding | ShrinkProceeding
SweepAnswer = Answered | Refused | SweepProgressAnswer
