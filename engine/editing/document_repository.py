"""The behaviors of a project as editable files: open, save without overwriting other changes, rename, delete."""

from __future__ import annotations

import json
import logging
import os
import re
import threading
import time
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import cast

from engine.cell.cell_names import CellNameKind, cell_names
from engine.check.analyzed_behavior import Catalogue
from engine.document.cell import Cell, load_cell
from engine.document.loader import parse_behavior
from engine.document.text.yaml_source import parse_source
from engine.editing.analysis.data_flow import KeyFlow, data_flow
from engine.editing.analysis.diagnostics import DocumentAnalysis, find_external_references
from engine.editing.catalogue import BehaviorReferenceView, behavior_reference_views
from engine.editing.cells.cell_documents import CellDocuments
from engine.editing.cells.naming_behaviors import behaviors_naming
from engine.editing.draft_cache import DraftCache, EditAnswer
from engine.editing.edits.edit import AnyEdit
from engine.editing.project_context import ProjectContext, StoredEntryNames
from engine.editing.referring_behavior import ReferringBehavior
from engine.editing.stored_document import (
    DocumentConflict,
    NoSuchDocument,
    StoredDocument,
    read_stored,
    writing_errors,
)
from engine.editing.templates import new_text
from engine.editing.text.draft import Draft
from engine.editing.text.node_merge import NodeMerge, Side, merge_by_nodes
from engine.editing.versions import DocumentVersion, VersionHistory, save_checked, write_atomically
from engine.errors import DocumentError, Position
from engine.host.state_folder_names import STATE_FOLDER
from engine.library.behavior_library import FindingView, Library
from engine.library.state_reloading import StateReloading

_ID = re.compile(r"behaviors(?:/[A-Za-z0-9_][A-Za-z0-9_. -]{0,79}){1,8}\.(?:yaml|yml|json)")
_LATER = re.compile(r"\.breakpoints\.ya?ml$")
_log = logging.getLogger("flexcell.documents")


class DocumentRepository:
    """The documents under `project/behaviors`; thread-safe.

    Args:
        project: The folder of the project.
        catalogue: The states by name.
        now_s: The wall clock, seconds since 1970.
        stored: The entries of open cells, by the file of the cell; for other cells the seed entries apply.
        cell: The open cell, whose names are offered.
    """

    def __init__(
        self,
        project: Path,
        catalogue: Catalogue,
        *,
        now_s: Callable[[], float] = time.time,
        stored: StoredEntryNames = lambda _: None,
        cell: Cell | None = None,
    ) -> None:
        self.catalogue = catalogue
        self._stored = stored
        self.cell = cell
        """The open cell."""
        self._project = project.resolve()
        self._versions = VersionHistory(self._project / STATE_FOLDER / "versions", now_s=now_s)
        self._writing = threading.Lock()
        self.cells = CellDocuments(self._project, self._versions, writing=self._writing, cell=cell)
        """The document of the open cell and the modules of the project as editable files."""
        self._drafts = DraftCache()
        self.states = StateReloading(self._project, catalogue)
        """What watches the modules of the project's own states."""
        self.library = Library(self._project, catalogue, cell=cell)
        """The behaviors among them, read as the last saved files say."""

    def reload_states(self) -> bool:
        """Load the changed modules of the project's states anew; return whether catalogue or findings have changed."""
        if not self.states.load():
            return False
        self._drafts.clear()
        self.library.forget()
        return True

    @property
    def project(self) -> Path:
        """The folder of the project."""
        return self._project

    def referable(self) -> tuple[BehaviorReferenceView, ...]:
        """Return the behaviors of the project that others may reference, sorted by id."""
        return behavior_reference_views(self.library)

    def naming(self, item: str) -> tuple[ReferringBehavior, ...]:
        """Return the saved behaviors for the open cell that name one of its items; none without a cell."""
        if self.cell is None:
            return ()
        context = ProjectContext(self.catalogue, self._project, self._project)
        return behaviors_naming(item, cell=self.cell, library=self.library, signature_of=context.signature)

    def offered(self) -> dict[CellNameKind, tuple[str, ...]]:
        """Return the names of the open cell by kind, as the check knows them; none without a cell."""
        return cell_names(self.cell).listed() if self.cell is not None else {}

    def offered_to(self, document_id: str, text: str) -> dict[CellNameKind, tuple[str, ...]]:
        """Return the names of the cell of a text by kind; those of the open cell if the text names none.

        None if that cell cannot be read, which the check reports, or is outside this project.
        """
        drawn = self.draw(document_id, text)
        written = drawn.document.cell if drawn.document is not None else None
        if written is None:
            return self.offered()
        try:
            file = (self.file_of(document_id).parent / written).resolve()
            return cell_names(load_cell(file)).listed() if file.is_relative_to(self._project) else {}
        except (DocumentError, OSError, ValueError):
            return {}  # the check reports the problem

    def file_of(self, document_id: str) -> Path:
        """Return the path of a document that exists or may be created.

        Raises:
            DocumentError: the id is not the id of a document, or leads out of the project.
        """
        parts = document_id.split("/")
        if not _ID.fullmatch(document_id) or any(part.endswith(".") or ".." in part for part in parts):
            hint = "an id is a path such as `behaviors/folder/name.yaml`"
            raise NoSuchDocument("this is not the id of a document", where=document_id[:200], hint=hint)
        file = (self._project / document_id).resolve()
        if not file.is_relative_to(self._project / "behaviors"):
            raise NoSuchDocument("the id leads out of the project", where=document_id)
        if _LATER.search(document_id):
            raise NoSuchDocument("a breakpoints file is not a behavior", where=document_id)
        return file

    def context(self, document_id: str) -> ProjectContext:
        """Return the project context of a document."""
        return ProjectContext(self.catalogue, self.file_of(document_id).parent, self._project, self._stored)

    def open(self, document_id: str) -> StoredDocument:
        """Return a document and keep its text as a version, the base of a later save.

        Raises:
            NoSuchDocument: there is no such document.
            DocumentError: it cannot be read as text, or is not a behavior.
        """
        file = self.file_of(document_id)
        opened = read_stored(document_id, file)
        _require_behavior(opened.text, document_id)
        with self._writing:
            self._remember(document_id, opened.text)
        return opened

    def examine(self, document_id: str, text: str) -> DocumentAnalysis:
        """Build the graph and the findings of a text, as if it were the document's."""
        return self._drafts.examine(text, file=self.file_of(document_id), context=self.context(document_id))

    def draw(self, document_id: str, text: str) -> DocumentAnalysis:
        """Build the graph of a text, as if it were the document's; `examine` checks it."""
        return self._drafts.draw(text, file=self.file_of(document_id), context=self.context(document_id))

    def findings(self, document_id: str, text: str) -> tuple[FindingView, ...]:
        """Check a text as if it were the document's, without building its graph again."""
        return self.examine(document_id, text).findings

    def edit(
        self, document_id: str, text: str, edits: Sequence[AnyEdit], *, check: bool = False, graph: str | None = None
    ) -> EditAnswer:
        """Apply edits to a text, all or none, and build the graph of the result; nothing is saved.

        With `check` the findings are in the answer; with the hash `graph` of a text, the difference from its graph.
        """
        file, context = self.file_of(document_id), self.context(document_id)
        return self._drafts.edit(text, edits, file=file, context=context, check=check, graph=graph)

    def data_flow(self, document_id: str, text: str) -> tuple[KeyFlow, ...]:
        """Return the writers and readers of each key of a text.

        Raises:
            DocumentError: the text is not a valid behavior, or leads out of the project.
        """
        file, context = self.file_of(document_id), self.context(document_id)
        dangling = next(iter(find_external_references(Draft(text, file=str(file)), context, file)), None)
        if dangling is not None:
            where = Position(file=document_id, line=dangling.line, column=dangling.column)
            raise DocumentError(dangling.message, where=where, hint=dangling.hint)
        return data_flow(parse_behavior(text, file=file), self.catalogue)

    def save(self, document_id: str, text: str, *, base_hash: str) -> StoredDocument:
        """Write a document that has not changed since it was opened.

        Args:
            document_id: Id of the document.
            text: The new text.
            base_hash: The hash of the text from which it was edited.

        Raises:
            DocumentConflict: the document has another text now.
            NoSuchDocument: the document no longer exists.
            DocumentError: the text is not a document.
        """
        file = self.file_of(document_id)
        _require_document(text, document_id)
        with self._changing(document_id):
            return save_checked(
                document_id,
                file,
                text,
                base_hash=base_hash,
                versions=self._versions,
                merged=lambda there: self._merged(there, text, base_hash, {}),
            )

    def merge(self, document_id: str, text: str, *, base_hash: str, sides: Mapping[str, Side]) -> DocumentConflict:
        """Return what a save of this text meets, merged with these choices; nothing is written."""
        there = read_stored(document_id, self.file_of(document_id))
        return DocumentConflict(there, self._merged(there, text, base_hash, sides))

    def create(self, document_id: str, *, template: str = "machine", name: str = "") -> StoredDocument:
        """Create a document from a template; it belongs to the open cell.

        Raises:
            DocumentError: the id is taken, or there is no such template.
        """
        file = self.file_of(document_id)
        text = new_text(template, name=name or file.stem, cell=self._cell_beside(file))
        if file.suffix == ".json":
            text = json.dumps(parse_source(text, file=document_id).data, indent=2, ensure_ascii=False) + "\n"
        return self._put(document_id, file, text)

    def _cell_beside(self, file: Path) -> str | None:
        return (
            Path(os.path.relpath(self.cell.file.resolve(), file.parent)).as_posix() if self.cell is not None else None
        )

    def add(self, document_id: str, text: str) -> StoredDocument:
        """Create a document from a text.

        Raises:
            DocumentError: the id is taken, or the text is not a behavior.
        """
        _require_document(text, document_id)
        return self._put(document_id, self.file_of(document_id), text)

    def duplicate(self, document_id: str, new_id: str) -> StoredDocument:
        """Copy a document; raises DocumentError if the new id is taken."""
        return self._put(new_id, self.file_of(new_id), read_stored(document_id, self.file_of(document_id)).text)

    def rename(self, document_id: str, new_id: str) -> StoredDocument:
        """Rename a document with its versions. References to it in other documents do not change.

        Raises:
            DocumentError: there is no such document, the new id is taken, or it has another format.
        """
        file, new = self.file_of(document_id), self.file_of(new_id)
        if (file.suffix == ".json") != (new.suffix == ".json"):
            raise DocumentError("a rename does not convert YAML to JSON", where=new_id, hint="keep the file extension")
        with self._changing(document_id):
            there = read_stored(document_id, file)
            _require_free(new, new_id)
            self._versions.keep(document_id, there.text)
            new.parent.mkdir(parents=True, exist_ok=True)
            file.rename(new)
            self._versions.rename(document_id, new_id)
        return read_stored(new_id, new)

    def delete(self, document_id: str) -> None:
        """Delete a document; its text is kept as a version.

        Raises:
            NoSuchDocument: there is no such document.
        """
        file = self.file_of(document_id)
        with self._changing(document_id):
            self._versions.keep(document_id, read_stored(document_id, file).text)
            file.unlink()

    def versions(self, document_id: str) -> tuple[DocumentVersion, ...]:
        """Return the versions of a document, newest first, also of a deleted one.

        Raises:
            NoSuchDocument: there never was such a document.
        """
        file = self.file_of(document_id)
        with self._writing:
            if file.is_file():
                self._remember(document_id, read_stored(document_id, file).text)
            found = self._versions.all(document_id)
        if not found:
            raise NoSuchDocument("there is no such document", where=document_id)
        return found

    def version(self, document_id: str, digest: str) -> str:
        """Return the text of a version; raises DocumentError if the version is not kept."""
        self.file_of(document_id)
        return self._versions.text(document_id, digest)

    def deleted(self) -> tuple[tuple[str, DocumentVersion], ...]:
        """Return the deleted documents of which a version is kept: id and newest version, newest first."""
        with self._writing:
            gone = [each for each in self._versions.ids() if not (self._project / each).exists()]
            found = [(each, self._versions.all(each)[0]) for each in gone if _ID.fullmatch(each)]
        return tuple(sorted(found, key=lambda each: -each[1].saved_at_s))

    def restore(self, document_id: str) -> StoredDocument:
        """Restore a deleted document from its newest version.

        Raises:
            NoSuchDocument: no version of it is kept.
            DocumentError: a document with its id exists.
        """
        file, latest = self.file_of(document_id), self.versions(document_id)[0]
        return self._put(document_id, file, self.version(document_id, latest.hash))

    def stamps(self) -> dict[str, tuple[int, int]]:
        """Return modification time (ns) and size of every document, by id; cheap enough to poll each second."""
        found: dict[str, tuple[int, int]] = {}
        folder = self._project / "behaviors"
        for file in folder.rglob("*"):
            if file.suffix in (".yaml", ".yml", ".json"):
                try:
                    status = file.stat()
                except OSError:
                    continue  # deleted during the listing
                found[file.relative_to(self._project).as_posix()] = (status.st_mtime_ns, status.st_size)
        return found

    def hash_on_disk(self, document_id: str) -> str | None:
        """Return the hash of a document as it is on disk; None if there is no such document."""
        try:
            return read_stored(document_id, self.file_of(document_id)).hash
        except DocumentError:
            return None  # deleted, or not text: nothing to compare with

    @contextmanager
    def _changing(self, document_id: str) -> Generator[None]:
        """Lock the files of the project; an OS error is raised with the document and a hint."""
        with self._writing, writing_errors(document_id):
            yield

    def _remember(self, document_id: str, text: str) -> None:
        """Keep the content of a file as a version; a read-only project can still be read."""
        try:
            self._versions.keep(document_id, text)
        except OSError as error:
            _log.warning("cannot keep a version of %s: %s", document_id, error)

    def _merged(self, there: StoredDocument, text: str, base_hash: str, sides: Mapping[str, Side]) -> NodeMerge | None:
        try:
            base = self._versions.text(there.id, base_hash)
        except DocumentError:
            return None  # the base text is unknown: a person must decide
        return merge_by_nodes(base, text, there.text, file=there.id, sides=sides)

    def _put(self, document_id: str, file: Path, text: str) -> StoredDocument:
        with self._changing(document_id):
            _require_free(file, document_id)
            file.parent.mkdir(parents=True, exist_ok=True)
            write_atomically(file, text)
            self._versions.keep(document_id, text, by="editor")
        return read_stored(document_id, file)


def _require_document(text: str, document_id: str) -> None:
    """Reject text that is not a YAML mapping; an invalid behavior may be saved, so that work can be interrupted."""
    data = parse_source(text, file=document_id).data
    if not isinstance(data, dict):
        raise DocumentError("the document is not a mapping", where=document_id, hint="begin it with `flexcell: 1`")
    _require_behavior_data(cast("dict[str, object]", data), document_id)


def _require_behavior(text: str, document_id: str) -> None:
    """Reject cells and entries documents, which may be in the same folder; invalid text may be opened to fix it."""
    try:
        data = parse_source(text, file=document_id).data
    except DocumentError:
        return
    if isinstance(data, dict):
        _require_behavior_data(cast("dict[str, object]", data), document_id)


def _require_behavior_data(data: dict[str, object], document_id: str) -> None:
    if "root" not in data and ("cell" in data or "robots" in data or "faults" in data or "breakpoints" in data):
        raise DocumentError("this is not a behavior", where=document_id, hint="the editor edits behaviors only")


def _require_free(file: Path, document_id: str) -> None:
    if file.exists():
        raise DocumentError("there is a document with this id", where=document_id, hint="choose another name")
