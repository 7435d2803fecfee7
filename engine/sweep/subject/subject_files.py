"""The files of a sweep, the folder that contains them, and texts without the paths of this machine."""

from __future__ import annotations

import os
import sysconfig
from collections.abc import Iterable, Iterator
from pathlib import Path

import msgspec

from engine.document.behavior import Behavior
from engine.sweep.subject.cell_files import model_files, model_paths
from engine.sweep.subject.source_files import SourceFile, with_imports
from engine.sweep.subject.sweep_subject import SweepSubject, importable_folders

_ENGINE = Path(__file__).resolve().parents[3]


def subject_root(subject: SweepSubject) -> Path:
    """Return the innermost folder that contains the documents, models and Python files of a sweep."""
    return Path(os.path.commonpath([folder.resolve() for folder in _folders(subject)]))


def subject_files(subject: SweepSubject) -> set[Path]:
    """Return the documents, models and Python files of a sweep: all that its runs read beside installed packages.

    The store, which each run copies, is not among them, nor is the sweep document itself.
    """
    files = {_placed(file) for file in _behavior_files(subject.behavior) if file.is_file()}
    for documents in (subject.faults, subject.substitutes):
        files |= {_placed(each.file) for each in documents.values()}
    files |= _sources(subject)
    if subject.cell is not None:
        files |= {_placed(subject.cell.file), *model_files(subject.cell)}
        if subject.cell.seed_file is not None:
            files.add(subject.cell.seed_file)
    return files


class PortableText:
    """Texts in which files have paths relative to their sweep or package: equal on all machines.

    Args:
        root: The folder that contains the files of the sweep.
    """

    def __init__(self, root: Path) -> None:
        packages = {sysconfig.get_path(name) for name in ("purelib", "platlib", "stdlib")}
        folders = {str(root), str(_ENGINE), *packages} - {os.sep}
        # An environment may be inside the project.
        self._prefixes = sorted((f"{folder}{os.sep}" for folder in folders), key=len, reverse=True)
        self._encoded = [msgspec.json.encode(prefix)[1:-1] for prefix in self._prefixes]

    def of(self, text: str) -> str:
        """Return a text with relative paths."""
        for prefix in self._prefixes:
            text = text.replace(prefix, "")
        return text

    def of_json(self, text: bytes) -> bytes:
        """Return JSON with relative paths."""
        for prefix in self._encoded:
            text = text.replace(prefix, b"")
        return text


def _folders(subject: SweepSubject) -> Iterator[Path]:
    yield subject.sweep.file.parent
    yield from (file.parent for file in _behavior_files(subject.behavior))
    for documents in (subject.faults, subject.substitutes):
        yield from (each.file.parent for each in documents.values())
    if subject.project is not None:
        yield subject.project.folder
    if subject.cell is not None:
        yield subject.cell.file.parent
        yield from model_paths(subject.cell)
        if subject.cell.seed_file is not None:
            yield subject.cell.seed_file.parent


def _placed(file: Path) -> Path:
    """Return the place of a file, which other documents name, and not what it may be a link to."""
    return file.parent.resolve() / file.name


def _behavior_files(behavior: Behavior) -> Iterator[Path]:
    yield behavior.file
    for other in behavior.references.values():
        yield from _behavior_files(other)


def _sources(subject: SweepSubject) -> set[Path]:
    """Return the project file and its modules, those of other behaviors included: all are loaded."""
    behavior, project = subject.behavior.file.resolve(), subject.project
    start = [SourceFile(behavior.stem, behavior)] if behavior.suffix == ".py" else []
    if project is None:
        return with_imports(start, importable_folders(project, subject.behavior))
    for name in project.document.states:
        path = project.folder.joinpath(*name.split("."))
        start += [SourceFile(name, file) for file in (path / "__init__.py", path.with_suffix(".py")) if file.is_file()]
    return {
        project.file,
        *_packages(start, project.folder),
        *with_imports(start, importable_folders(project, subject.behavior)),
    }


def _packages(sources: Iterable[SourceFile], project: Path) -> set[Path]:
    """Return the packages around modules: Python loads them first."""
    around = {folder / "__init__.py" for source in sources for folder in source.file.parents}
    return {file for file in around if file.is_relative_to(project) and file.is_file()}
