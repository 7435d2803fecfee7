"""The sweep documents of a project folder: found, and new ones written inside it only."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path, PurePosixPath
from typing import Any, cast

import msgspec

from engine.document import write_yaml
from engine.document.sweep import NO_FILE, PointsFile, SweepDocument, sweep_of_source
from engine.document.text.yaml_source import load_source, parse_source
from engine.errors import DocumentError

_SUFFIXES = (".yaml", ".yml", ".json")
_READ = (*_SUFFIXES, ".py", ".csv", ".db")
"""Files that decide what a sweep is."""
_KEEP_OUT = frozenset({"node_modules", "site-packages", "__pycache__"})
_DEPTH = 6
_MOST_FOLDERS = 5000
_MOST_BYTES = 1_000_000
_NAMES_BEHAVIOR = re.compile(rb"""(?:^|[{,])\s*["']?behavior["']?\s*:""", re.MULTILINE)
_NEW_ID = re.compile(r"([A-Za-z0-9_][\w .-]*/)*[A-Za-z0-9_][\w .-]*\.yaml")
Stamps = Mapping[str, tuple[int, int]]


class NoSuchSweep(DocumentError):
    """There is no sweep document, or no result of a run, with this name."""


def project_stamps(project: Path) -> Stamps:
    """Return time and size of each file of a project that may decide what a sweep of it is, by its path there."""
    return {name: (status.st_mtime_ns, status.st_size) for name, status in _files(project.resolve())}


def sweep_ids(project: Path, stamps: Stamps) -> list[str]:
    """Return the paths of the sweep documents among the files of a project, in order; also of invalid ones."""
    return sorted(name for name in stamps if name.endswith(_SUFFIXES) and _is_sweep(project / name))


def sweep_file(project: Path, sweep_id: str) -> Path:
    """Return the file of a sweep by its path in the project.

    Raises:
        NoSuchSweep: it leads out of the project, or there is no such document.
    """
    file = project.resolve() / sweep_id
    try:
        inside = "\0" not in sweep_id and file.resolve().is_relative_to(project.resolve())
        known = inside and file.suffix in _SUFFIXES and file.is_file() and _is_sweep(file)
    except OSError:
        # A name that is too long for this file system.
        known = False
    if not known:
        raise NoSuchSweep(f"there is no sweep {sweep_id[:120]!r}", hint="see the list of sweeps of this project")
    return file


def new_sweep_text(project: Path, sweep_id: str, document: SweepDocument) -> tuple[Path, str]:
    """Return the file and the text of a new sweep document; the paths in `document` are relative to the project.

    Raises:
        DocumentError: the name is taken or not a name for it, a path leads out of the project, or it is not valid.
    """
    file = new_document_file(project, sweep_id)
    moved = _moved(document, project.resolve(), file.parent)
    text = write_yaml(cast("dict[str, Any]", _written(moved)))
    sweep_of_source(parse_source(text, file=str(file)), file=file)
    return file, text


def new_document_file(project: Path, sweep_id: str) -> Path:
    """Return the file of a new sweep document.

    Raises:
        DocumentError: the name is taken or not a name for it.
    """
    root = project.resolve()
    file = root / sweep_id
    if not _NEW_ID.fullmatch(sweep_id) or len(sweep_id) > 200 or not file.resolve().is_relative_to(root):
        hint = "letters, digits, `_`, `-` and `/`, with `.yaml` at the end: behaviors/sweeps/transfer.yaml"
        raise DocumentError(f"{sweep_id[:120]!r} is not a name for a sweep", where="id", hint=hint)
    if file.exists():
        raise DocumentError(f"there is a file {sweep_id} already", where="id", hint="choose another name")
    return file


def _files(root: Path) -> Iterator[tuple[str, os.stat_result]]:
    pending = [(root, 0)]
    folders = 0
    while pending and folders < _MOST_FOLDERS:
        folder, depth = pending.pop()
        folders += 1
        try:
            entries = list(os.scandir(folder))
        except OSError:
            # A folder that was removed meanwhile, or that this user may not read, has no sweeps for him.
            continue
        for entry in entries:
            if entry.name.startswith(".") or entry.name in _KEEP_OUT:
                continue
            if entry.is_dir(follow_symlinks=False):
                if depth < _DEPTH:
                    pending.append((Path(entry.path), depth + 1))
            elif entry.name.endswith(_READ) and entry.is_file():
                yield Path(entry.path).relative_to(root).as_posix(), entry.stat()


def _is_sweep(file: Path) -> bool:
    """Tell whether a document is of a behavior without being one; the text is looked at first, as it is faster."""
    try:
        if file.stat().st_size > _MOST_BYTES or not _NAMES_BEHAVIOR.search(file.read_bytes()):
            return False
        data = load_source(file).data
    except (OSError, DocumentError):
        # The editor tells what is wrong with a document that cannot be read.
        return False
    return isinstance(data, dict) and "behavior" in data and "root" not in data and "flexcell" in data


def _moved(document: SweepDocument, root: Path, folder: Path) -> SweepDocument:
    """Return a document whose paths, given relative to the project, are relative to its own folder."""

    def moved(path: str) -> str:
        if PurePosixPath(path).is_absolute() or not (root / path).resolve().is_relative_to(root):
            raise DocumentError("this path leads out of the project", where=path, hint="give a file of the project")
        return os.path.relpath((root / path).resolve(), folder.resolve())

    named = {key: moved(path) for key in ("behavior", "cell", "store") if (path := getattr(document, key)) is not None}
    for key in ("faults", "substitutes"):
        if getattr(document, key) is not None:
            named[key] = moved(getattr(document, key))
    factors = {
        address: msgspec.structs.replace(
            factor, values=tuple(each if each == NO_FILE else moved(str(each)) for each in factor.values)
        )
        if address in ("faults", "substitutes") and factor.values is not None
        else factor
        for address, factor in document.factors.items()
    }
    design = document.design
    if isinstance(design, PointsFile):
        design = PointsFile(csv=moved(design.csv))
    return msgspec.structs.replace(document, **named, factors=factors, design=design)


def _written(value: object) -> object:
    """Return plain data without what is as it is by default."""
    if isinstance(value, msgspec.Struct):
        return {
            each.encode_name: _written(given)
            for each in msgspec.structs.fields(value)
            if (given := getattr(value, each.name)) != each.default and given != {}
        }
    if isinstance(value, dict):
        return {key: _written(each) for key, each in cast("dict[str, object]", value).items()}
    return msgspec.to_builtins(value)
