"""The documents stored in a recording, so that it can be replayed where they are missing or changed."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from tempfile import TemporaryDirectory

import msgspec

from engine.document.behavior import Behavior
from engine.document.cell import Cell
from engine.document.loader import load_behavior
from engine.document.substitutes import Substitutes, parse_substitutes
from engine.errors import RecordingError

YAML_TYPE = "application/yaml"
_SUBSTITUTES = ".substitutes.json"


@dataclass(frozen=True, kw_only=True)
class RecordedDocuments:
    """Texts by path relative to one folder; `behavior` and `cell` name two of them.

    `meshes` are the digests of the mesh files of the cell, by the names that it has for them.
    """

    behavior: str
    cell: str = ""
    texts: Mapping[str, bytes] = field(default_factory=dict[str, bytes])
    meshes: Mapping[str, str] = field(default_factory=dict[str, str])

    def unpack(self, folder: Path) -> Path:
        """Write the documents to `folder` and return the path of the behavior.

        Raises:
            RecordingError: a name leads out of the folder.
        """
        if self.behavior not in self.texts:
            raise RecordingError("the behavior is not in this recording", where=self.behavior, hint="give --behavior")
        for name, text in self.texts.items():
            place = PurePosixPath(name)
            if place.is_absolute() or ".." in place.parts or not place.parts or "\0" in name:
                raise RecordingError(f"a document has the invalid name {name!r}", hint="record it again")
            file = folder / place
            try:
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_bytes(text)
            except OSError as error:
                raise RecordingError(f"cannot unpack {name!r}: {error.strerror or error}", where=folder) from error
        return folder / self.behavior


def recorded_behavior(documents: RecordedDocuments) -> Behavior:
    """Return the behavior that was executed, with its substitutes.

    Raises:
        FlexcellError: the documents are damaged.
    """
    with TemporaryDirectory(prefix="flexcell-") as folder:
        behavior = load_behavior(documents.unpack(Path(folder)))
    return behavior.with_substitutes(recorded_substitutes(documents))


def recorded_substitutes(documents: RecordedDocuments) -> Substitutes | None:
    """Return the substitutes of an executed behavior; None if there were none.

    Raises:
        DocumentError: the document is damaged.
    """
    text = documents.texts.get(_SUBSTITUTES)
    return parse_substitutes(text, file=_SUBSTITUTES) if text is not None else None


def collect_documents(behavior: Behavior, cell: Cell | None = None) -> RecordedDocuments:
    """Read the documents of a run: the behavior, all that it references, the cell with its modules and entries.

    Raises:
        RecordingError: one of the files can no longer be read.
    """
    texts = dict(_texts(behavior))
    cell_file = cell.file.resolve() if cell is not None else None
    modules = [module.file for module in cell.modules.values()] if cell is not None else []
    for file in (cell_file, cell.seed_file if cell is not None else None, *modules):
        if file is not None:
            texts[file.resolve()] = _read(file)
    folder = Path(os.path.commonpath([file.parent for file in texts]))
    return RecordedDocuments(
        behavior=behavior.file.resolve().relative_to(folder).as_posix(),
        cell=cell_file.relative_to(folder).as_posix() if cell_file is not None else "",
        meshes=cell.meshes if cell is not None else {},
        texts={**{file.relative_to(folder).as_posix(): text for file, text in texts.items()}, **_substitutes(behavior)},
    )


def _substitutes(behavior: Behavior) -> dict[str, bytes]:
    return {_SUBSTITUTES: behavior.substitutes.text} if behavior.substitutes is not None else {}


def _texts(behavior: Behavior) -> Iterator[tuple[Path, bytes]]:
    file = behavior.file.resolve()
    # A behavior defined in Python or parsed from text has no file, even if its path exists.
    own = Path(behavior.source.file) == behavior.file and file.is_file()
    yield file, _read(file) if own else msgspec.json.format(msgspec.json.encode(behavior.document))
    for target in behavior.references.values():
        yield from _texts(target)


def _read(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError as error:
        reason = error.strerror or str(error)
        raise RecordingError(f"this document cannot be recorded: {reason}", where=file, hint="save it again") from error
