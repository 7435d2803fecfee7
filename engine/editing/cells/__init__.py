"""Editing of cell and module documents: edits of their items, what they say, and their files."""

from engine.editing.cells.cell_documents import CellDocumentName, CellDocuments, OpenedCellDocument
from engine.editing.cells.cell_draft import CellDraft, DraftItem
from engine.editing.cells.cell_edit import AnyCellEdit
from engine.editing.cells.cell_editing import CellEditAnswer
from engine.editing.cells.naming_behaviors import behaviors_naming

__all__ = [
    "AnyCellEdit",
    "CellDocumentName",
    "CellDocuments",
    "CellDraft",
    "CellEditAnswer",
    "DraftItem",
    "OpenedCellDocument",
    "behaviors_naming",
]
