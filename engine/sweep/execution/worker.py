"""The process that executes runs of a sweep, one after the other, with everything loaded once."""

from __future__ import annotations

import os
import resource
import signal
import socket
import tempfile
from collections.abc import Mapping
from multiprocessing.connection import Connection

import msgspec

from engine.document.sweep import parse_sweep
from engine.errors import DocumentError, FlexcellError
from engine.host.child_process import set_parent_death_signal
from engine.sweep.design.configuration import Configuration
from engine.sweep.execution.trial import Trials
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.subject.sweep_subject import SweepSubject, other_versions

CODE = "import sys; from engine.sweep.execution.worker import main; main(int(sys.argv[1]))"
"""The program of the process; its argument is the number of its socket."""


class WorkerTask(msgspec.Struct, frozen=True, kw_only=True):
    """What a worker executes runs of."""

    document: str
    """The sweep, as JSON."""
    file: str
    versions: Mapping[str, str]
    """Those that its subject must have: a document may have changed since the sweep began."""
    memory_bytes: int
    folder: str = ""
    """Where relative paths of documents lead; by default the folder of its parent."""
    scratch: str = ""
    """Where its temporary files are, which its parent removes: a process that is killed removes nothing."""


class WorkerAnswer(msgspec.Struct, frozen=True, kw_only=True):
    """The result of one configuration, or why no configuration can be executed."""

    result: TrialResult | None = None
    failure: str = ""


def main(descriptor: int) -> None:
    """Answer configurations until the socket is closed; the parent process may kill this one at any time."""
    # Ctrl-C reaches the whole process group; the parent decides what ends.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # What states print does not belong in the output of the command.
    os.dup2(2, 1)
    connection = Connection(descriptor)
    with socket.socket(fileno=os.dup(descriptor)) as watched:
        set_parent_death_signal(watched)
        _answer(connection)


def _answer(connection: Connection) -> None:
    task = msgspec.json.decode(connection.recv_bytes(), type=WorkerTask)
    _, hard = resource.getrlimit(resource.RLIMIT_DATA)
    resource.setrlimit(resource.RLIMIT_DATA, (task.memory_bytes, hard))
    if task.folder:
        os.chdir(task.folder)
    tempfile.tempdir = task.scratch or None
    trials: Trials | None = None
    while True:
        try:
            asked = connection.recv_bytes()
        except EOFError:
            return
        try:
            trials = trials or Trials(_subject(task))
        except FlexcellError as error:
            connection.send_bytes(msgspec.json.encode(WorkerAnswer(failure=str(error))))
            return
        result = trials.run(msgspec.json.decode(asked, type=Configuration))
        connection.send_bytes(msgspec.json.encode(WorkerAnswer(result=result)))


def _subject(task: WorkerTask) -> SweepSubject:
    subject = SweepSubject.load(parse_sweep(task.document, file=task.file))
    found = other_versions(subject.versions, task.versions)
    if found:
        raise DocumentError(
            f"what decides a run is not as it was when the sweep began: {found}",
            where=task.file,
            hint="start the sweep again: results of both versions are kept apart",
        )
    return subject
