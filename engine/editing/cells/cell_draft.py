"""What the text of a cell or module document says: its items with their lines, its findings, where its frames are."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal, cast, get_args

import msgspec

from engine.cell.cell_items import TextExcerpts
from engine.check.cell.mesh_checks import missing_meshes
from engine.document.cell import CellDocument, cell_of_source
from engine.document.cell_frames import poses_in_world
from engine.document.module_document import ModuleDocument, module_of_source
from engine.document.text.yaml_source import DocumentSource, parse_source
from engine.editing.analysis.diagnostics import text_hash
from engine.editing.cells.cell_edit import CellSection
from engine.errors import DocumentError, Position
from engine.library.behavior_library import FindingView
from engine.messages import Pose

CellDocumentKind = Literal["cell", "module"]
SECTIONS: dict[CellDocumentKind, tuple[CellSection, ...]] = {
    "cell": get_args(CellSection),
    "module": ("fixtures", "parts", "cameras", "frames", "devices", "bonds"),
}


class DraftItem(msgspec.Struct, frozen=True, kw_only=True):
    """An item of a document as written, with its first and last line, from 1."""

    section: CellSection
    name: str
    line: int
    end_line: int
    value: dict[str, object]


class CellDraft(msgspec.Struct, frozen=True, kw_only=True):
    """What a text says; one that cannot be read has findings and no items.

    `frames` are the poses in the world, or in the frame of the module, of all that something may stand in, `parts`
    those of parts, `positions` those of devices, by names in the cell; none while the text has errors. The path of a
    finding is `fixtures/floor`, empty for one that is in no item.
    """

    text: str
    hash: str
    kind: CellDocumentKind
    items: tuple[DraftItem, ...] = ()
    findings: tuple[FindingView, ...] = ()
    frames: dict[str, Pose] = {}
    parts: dict[str, Pose] = {}
    positions: dict[str, tuple[str, ...]] = {}


@dataclass(frozen=True, kw_only=True)
class _Meaning:
    """What a text without errors says beside its items."""

    frames: dict[str, Pose] = field(default_factory=dict[str, Pose])
    parts: dict[str, Pose] = field(default_factory=dict[str, Pose])
    positions: dict[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])


def read_cell_draft(text: str, *, file: Path, kind: CellDocumentKind) -> CellDraft:
    """Read and check a text as if it were in this file; modules that it names are read from disk."""
    items: tuple[DraftItem, ...] = ()
    meaning = _Meaning()
    findings: tuple[FindingView, ...] = ()
    try:
        source = parse_source(text, file=str(file))
        items = _items(source, text, kind)
        document = (cell_of_source if kind == "cell" else module_of_source)(source, file=file).document
        meaning = _meaning(document)
        missing = missing_meshes(document.fixtures, source, file.parent)
        findings = tuple(
            _view(each.message, each.position, file, items, code=each.code, hint=each.hint) for each in missing
        )
    except DocumentError as error:
        findings = tuple(_finding(each, file, items) for each in (error, *error.others))
    except OSError as error:
        message = f"a module cannot be read: {error.strerror}"
        findings = (_finding(DocumentError(message, where=str(error.filename)), file, items),)
    return CellDraft(
        text=text,
        hash=text_hash(text),
        kind=kind,
        items=items,
        findings=findings,
        frames=meaning.frames,
        parts=meaning.parts,
        positions=meaning.positions,
    )


def _meaning(document: CellDocument | ModuleDocument) -> _Meaning:
    poses = poses_in_world(document.frames, document.fixtures)
    return _Meaning(
        frames=poses,
        parts={name: part.at.in_world(poses).pose() for name, part in document.parts.items()},
        positions={name: tuple(device.positions) for name, device in document.devices.items()},
    )


def _items(source: DocumentSource, text: str, kind: CellDocumentKind) -> tuple[DraftItem, ...]:
    data: object = source.data
    if not isinstance(data, dict):
        return ()
    excerpts = TextExcerpts(source=source, lines=text.splitlines())
    sections = cast("dict[str, object]", data)
    found: list[DraftItem] = []
    for section in SECTIONS[kind]:
        written = sections.get(section)
        for name, value in cast("dict[str, object]", written).items() if isinstance(written, dict) else ():
            lines, line = excerpts.of([section, name])
            fields = cast("dict[str, object]", value) if isinstance(value, dict) else {}
            found.append(
                DraftItem(section=section, name=name, line=line, end_line=line + lines.count("\n"), value=fields)
            )
    return tuple(found)


def _finding(error: DocumentError, file: Path, items: tuple[DraftItem, ...]) -> FindingView:
    return _view(error.message, error.where, file, items, code="invalid-document", hint=error.hint or "")


def _view(
    message: str, where: object, file: Path, items: tuple[DraftItem, ...], *, code: str, hint: str
) -> FindingView:
    line, column = 0, 0
    if isinstance(where, Position) and where.file == str(file):
        line, column = where.line, where.column
    elif where is not None:
        message = f"{message} ({where})"
    item = next((each for each in items if each.line <= line <= each.end_line), None)
    return FindingView(
        severity="error",
        code=code,
        message=message,
        path=f"{item.section}/{item.name}" if item is not None else "",
        line=line,
        column=column,
        hint=hint,
    )
