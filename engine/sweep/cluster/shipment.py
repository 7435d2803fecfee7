"""What the workers of a cluster are sent of a sweep, so that they need no file system in common with its driver."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path

import msgspec

from engine.document.behavior import Behavior
from engine.document.sweep import NO_FILE, Sweep, SweepDocument
from engine.errors import DocumentError, FlexcellError
from engine.sweep.subject.cell_files import written_paths
from engine.sweep.subject.subject_files import subject_files, subject_root
from engine.sweep.subject.sweep_subject import SweepSubject

_FILES = ("faults", "substitutes")
_STORE = ".flexcell-sweep-store.db"
"""The store may be anywhere on this machine."""


class Shipment(msgspec.Struct, frozen=True, kw_only=True):
    """The files of a subject, by path relative to one folder."""

    document: str
    """The sweep as JSON, with relative paths only."""
    file: str
    """Its path; there need not be such a file."""
    files: Mapping[str, bytes]

    def unpack(self, folder: Path) -> None:
        """Write the files below a new folder, where all their relative paths lead to one another.

        Raises:
            OSError: they cannot be written.
        """
        (folder / self.file).parent.mkdir(parents=True, exist_ok=True)
        for name, content in self.files.items():
            file = folder / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content)


def pack(subject: SweepSubject) -> Shipment:
    """Read the files of a subject: its documents, the modules of its project, its models, and its store.

    Raises:
        DocumentError: a document names another one by an absolute path, which would lead elsewhere on a worker.
        FlexcellError: a file cannot be read.
    """
    _require_relative(subject)
    folder, root = subject.sweep.file.parent.resolve(), subject_root(subject)
    files = {file.relative_to(root).as_posix(): _content(file) for file in sorted(subject_files(subject))}
    return Shipment(
        document=msgspec.json.encode(_with_relative_paths(subject, folder, root)).decode(),
        file=(folder / subject.sweep.file.name).relative_to(root).as_posix(),
        files={**files, **_store(subject)},
    )


def _store(subject: SweepSubject) -> dict[str, bytes]:
    """Return the store, with what has been written and is not in the file itself yet."""
    store = subject.store_file
    if store is None:
        return {}
    log = store.with_name(f"{store.name}-wal")
    files = {_STORE: _content(store)}
    return {**files, f"{_STORE}-wal": _content(log)} if log.is_file() else files


def _with_relative_paths(subject: SweepSubject, folder: Path, root: Path) -> SweepDocument:
    """Return the document of a sweep, with what it names relative to its folder."""
    sweep = subject.sweep
    named = {key: getattr(sweep.document, key) for key in ("behavior", "cell", *_FILES)}
    paths = {key: os.path.relpath(sweep.resolve(name), folder) for key, name in named.items() if name is not None}
    if subject.store_file is not None:
        paths["store"] = os.path.relpath(root / _STORE, folder)
    return msgspec.structs.replace(sweep.document, **paths)


def _require_relative(subject: SweepSubject) -> None:
    for name, where in _names(subject):
        if Path(name).is_absolute():
            raise DocumentError(
                f"`{name}` is an absolute path, which leads elsewhere on a worker of the cluster",
                where=where,
                hint="write it relative to the document",
            )


def _names(subject: SweepSubject) -> Iterator[tuple[str, object]]:
    """Yield the paths that documents write, with the document or its position."""
    yield from _factor_names(subject.sweep)
    behavior, cell = subject.behavior, subject.cell
    if behavior.document.cell is not None and subject.sweep.document.cell is None:
        yield behavior.document.cell, behavior.file
    yield from _references(behavior)
    if cell is not None:
        yield from ((name, cell.file) for name in written_paths(cell))


def _factor_names(sweep: Sweep) -> Iterator[tuple[str, object]]:
    for kind in _FILES:
        factor = sweep.document.factors.get(kind)
        for value in (factor.values or ()) if factor is not None else ():
            if value != NO_FILE:
                yield str(value), sweep.position(kind)


def _references(behavior: Behavior) -> Iterator[tuple[str, object]]:
    for name, other in behavior.references.items():
        yield name, behavior.file
        yield from _references(other)


def _content(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError as error:
        reason = error.strerror or str(error)
        raise FlexcellError(f"this file cannot be sent to workers: {reason}", where=file) from error
