"""The document of the open cell and the modules of its project as editable files; the open cell does not change."""

from __future__ import annotations

import os
import threading
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec

from engine.document.cell import Cell
from engine.document.module_document import MODULE_FILE
from engine.document.text.yaml_source import parse_source
from engine.editing.cells.cell_draft import CellDocumentKind, CellDraft, read_cell_draft
from engine.editing.cells.cell_edit import AnyCellEdit
from engine.editing.cells.cell_editing import CellEditAnswer, apply_cell_edits
from engine.editing.stored_document import (
    NoSuchDocument,
    StoredDocument,
    read_stored,
    writing_errors,
)
from engine.editing.text.node_merge import NodeMerge
from engine.editing.text.three_way_merge import merge_texts
from engine.editing.versions import VersionHistory, save_checked
from engine.errors import DocumentError

_MOST_MODULES = 200
# Folders that have no modules, and may have very many files.
_SKIPPED = frozenset(("node_modules", "__pycache__"))


class CellDocumentName(msgspec.Struct, frozen=True, kw_only=True):
    """A document that can be edited: its id is its path in the project.

    `folder` is what a cell document beside the open one writes for a module; empty for the cell itself.
    """

    id: str
    kind: CellDocumentKind
    folder: str = ""


@dataclass(frozen=True, kw_only=True)
class OpenedCellDocument:
    """A document as it is on disk, with what it says."""

    stored: StoredDocument
    draft: CellDraft


class CellDocuments:
    """The documents; thread-safe.

    Args:
        project: The folder of the project, resolved.
        versions: The versions of its documents.
        writing: Held while a document of the project is written.
        cell: The open cell.
    """

    def __init__(
        self, project: Path, versions: VersionHistory, *, writing: threading.Lock, cell: Cell | None = None
    ) -> None:
        self._project = project
        self._versions = versions
        self._writing = writing
        self._cell_file = cell.file.resolve() if cell is not None else None

    def listed(self) -> tuple[CellDocumentName, ...]:
        """Return the cell first, if its file is in the project, and then the modules by their ids."""
        beside = self._cell_file.parent if self._cell_file is not None else self._project
        modules = [
            CellDocumentName(
                id=file.relative_to(self._project).as_posix(),
                kind="module",
                folder=Path(os.path.relpath(file.parent, beside)).as_posix(),
            )
            for file in self._module_files()
        ]
        return (*self._cell_name(), *sorted(modules, key=lambda each: each.id))

    def open(self, document_id: str) -> OpenedCellDocument:
        """Return a document and keep its text as a version, the base of a later save.

        Raises:
            NoSuchDocument: this is not the open cell and no module of the project.
            DocumentError: it cannot be read as text.
        """
        file = self._file_of(document_id)
        stored = read_stored(document_id, file)
        with self._writing, writing_errors(document_id):
            self._versions.keep(document_id, stored.text)
        return OpenedCellDocument(stored=stored, draft=self.examine(document_id, stored.text))

    def examine(self, document_id: str, text: str) -> CellDraft:
        """Return what a text says, as if it were the document's."""
        file = self._file_of(document_id)
        return read_cell_draft(text, file=file, kind=self._kind_of(file))

    def edit(self, document_id: str, text: str, edits: Sequence[AnyCellEdit]) -> CellEditAnswer:
        """Apply edits to a text, all or none; nothing is saved."""
        made, refused = apply_cell_edits(text, edits, file=str(self._file_of(document_id)))
        return CellEditAnswer(draft=self.examine(document_id, made), refused=refused)

    def save(self, document_id: str, text: str, *, base_hash: str) -> StoredDocument:
        """Write a document that has not changed since it was opened; the open cell does not change by this.

        Args:
            document_id: Id of the document.
            text: The new text, which may have errors.
            base_hash: The hash of the text from which it was edited.

        Raises:
            DocumentConflict: the document has another text now.
            NoSuchDocument: this is no such document, or it no longer exists.
            DocumentError: the text is not a mapping, or the file cannot be written.
        """
        file = self._file_of(document_id)
        if not isinstance(parse_source(text, file=document_id).data, dict):
            raise DocumentError("the document is not a mapping", where=document_id, hint="begin it with `flexcell: 1`")
        with self._writing, writing_errors(document_id):
            return save_checked(
                document_id,
                file,
                text,
                base_hash=base_hash,
                versions=self._versions,
                merged=lambda there: self._merged(there, text, base_hash),
            )

    def _merged(self, there: StoredDocument, text: str, base_hash: str) -> NodeMerge | None:
        """Return the lines of both, where they change different ones and the result has no errors."""
        try:
            base = self._versions.text(there.id, base_hash)
        except DocumentError:
            return None  # the base text is unknown: a person must decide
        merged = merge_texts(base, text, there.text).text
        if merged is None or self.examine(there.id, merged).findings:
            return None
        return NodeMerge(text=merged, conflicts=(), theirs_changed=())

    def _cell_name(self) -> tuple[CellDocumentName, ...]:
        file = self._cell_file
        if file is None or not file.is_relative_to(self._project):
            return ()
        return (CellDocumentName(id=file.relative_to(self._project).as_posix(), kind="cell"),)

    def _kind_of(self, file: Path) -> CellDocumentKind:
        return "cell" if file == self._cell_file else "module"

    def cell_file(self, document_id: str) -> Path | None:
        """Return the file of the cell; None for a document of a module. Raises NoSuchDocument as `open` does."""
        file = self._file_of(document_id)
        return file if self._kind_of(file) == "cell" else None

    def _file_of(self, document_id: str) -> Path:
        if any(part.startswith(".") or part in _SKIPPED for part in document_id.split("/")):
            raise _no_document(document_id)
        file = self._project / document_id
        try:
            file = file.resolve()
        except (OSError, ValueError):
            raise _no_document(document_id) from None
        if not file.is_relative_to(self._project) or (file != self._cell_file and file.name != MODULE_FILE):
            raise _no_document(document_id)
        return file

    def _module_files(self) -> list[Path]:
        found: list[Path] = []
        for folder, folders, files in os.walk(self._project):
            folders[:] = sorted(each for each in folders if each not in _SKIPPED and not each.startswith("."))
            if MODULE_FILE in files:
                found.append(Path(folder) / MODULE_FILE)
            if len(found) == _MOST_MODULES:
                break
        return found


def _no_document(document_id: str) -> NoSuchDocument:
    hint = f"the open cell can be edited, and each {MODULE_FILE} of the project"
    return NoSuchDocument("this is no document of a cell", where=document_id[:200], hint=hint)
