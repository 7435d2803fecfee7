"""The sweep process: reads and executes the sweeps of a project, separate from the server and its event loop."""

from __future__ import annotations

import os
import signal
import socket
from collections.abc import Callable, Generator
from contextlib import contextmanager
from pathlib import Path

import msgspec

from engine.errors import ControlError, FlexcellError
from engine.host.child_process import set_parent_death_signal
from engine.sweep_library.sweep_files import NoSuchSweep
from engine.sweep_library.sweep_reader import SweepReader
from engine.sweep_library.sweep_requests import (
    Answered,
    CompareSweep,
    CreateSweep,
    ExecuteSweep,
    FindBaselines,
    ListSweeps,
    OfferFactors,
    Proceeding,
    ReadRuns,
    ReadSweep,
    ReadTrial,
    RecordTrial,
    RefusalKind,
    Refused,
    SaveCase,
    ShrinkProceeding,
    ShrinkTrial,
    SweepAnswer,
    SweepProgressAnswer,
    SweepRequest,
)

_NICER_BY = 10
Send = Callable[[SweepProgressAnswer], None]


def main(descriptor: int) -> None:
    """Serve the socket until the other end closes it; the parent process may kill this one at any time."""
    connection = socket.socket(fileno=descriptor)
    set_parent_death_signal(connection)
    # Moving arms, the server and the page have priority; the workers of a sweep inherit this.
    os.nice(_NICER_BY)
    # What states print does not belong in the output of the server.
    os.dup2(2, 1)
    # Ctrl-C reaches the whole process group; only the execution of a sweep is ended by it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def send(answer: SweepAnswer) -> None:
        connection.sendall(msgspec.json.encode(answer) + b"\n")

    reader: SweepReader | None = None
    with connection.makefile("rb") as requests:
        project = Path(requests.readline().decode().rstrip("\n"))
        for line in requests:
            reader = reader or SweepReader(project)
            send(answer(reader, msgspec.json.decode(line, type=SweepRequest), send))


def answer(reader: SweepReader, request: SweepRequest, send: Send) -> Answered | Refused:
    """Return the answer to a request; `send` is called with how far it is."""
    try:
        return Answered(body=msgspec.Raw(msgspec.json.encode(_answered(reader, request, send))))
    except FlexcellError as error:
        where = "" if error.where is None else str(error.where)
        return Refused(kind=_kind(error), words=(error.message, where, error.hint or ""))
    except ModuleNotFoundError as error:
        hint = "pip install 'flexcell[sim,sweep]'"
        return Refused(kind="state", words=(f"sweeps need a package: {error}", "", hint))


def _answered(reader: SweepReader, request: SweepRequest, send: Send) -> object:
    match request:
        case ListSweeps():
            return reader.list()
        case ReadSweep():
            return reader.view(request.sweep)
        case ReadRuns():
            return reader.runs(request.sweep)
        case ReadTrial():
            return reader.trial(request.sweep, request.number)
        case OfferFactors():
            return reader.factors(request.behavior)
        case CreateSweep():
            return reader.create(request.sweep, request.document)
        case RecordTrial():
            return reader.record(request.sweep, request.number)
        case SaveCase():
            return reader.save_case(request.sweep, request.case, request.found)
        case FindBaselines():
            return reader.baselines(request.sweep)
        case CompareSweep():
            return reader.compare(
                request.sweep, results=request.results, version=request.version, margin=request.margin
            )
        case ExecuteSweep():
            with _interruptible():
                return reader.execute(request.sweep, again=request.again, show=lambda live: send(Proceeding(live=live)))
        case ShrinkTrial():
            with _interruptible():
                return reader.shrink(
                    request.sweep,
                    request.number,
                    same=request.same,
                    show=lambda progress: send(ShrinkProceeding(progress=progress)),
                )


@contextmanager
def _interruptible() -> Generator[None]:
    """Let Ctrl-C end what is executed."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)


def _kind(error: FlexcellError) -> RefusalKind:
    if isinstance(error, NoSuchSweep):
        return "missing"
    return "state" if isinstance(error, ControlError) else "invalid"
