"""The cell that a behavior is checked in, read once for all checks."""

from __future__ import annotations

from dataclasses import dataclass

from engine.cell.cell_names import CellNames, cell_names
from engine.document.behavior import Behavior
from engine.document.cell import Cell, load_cell
from engine.document.entries_document import Entries, load_entries
from engine.errors import DocumentError


@dataclass(frozen=True, kw_only=True)
class CellContext:
    """A cell, the names in it, and the seed entries of its store; each None if unknown.

    `mistake` is the reason why a part of a given cell is unknown.
    """

    cell: Cell | None = None
    names: CellNames | None = None
    seed: Entries | None = None
    mistake: DocumentError | None = None


def cell_context(behavior: Behavior, cell: Cell | None = None) -> CellContext:
    """Read the cell of a behavior: the given one, else the one that it names."""
    if cell is None and behavior.cell_file is None:
        return CellContext()
    seed: Entries | None = None
    try:
        cell = cell if cell is not None else load_cell(behavior.cell_file or "")
        seed = load_entries(cell.seed_file) if cell.seed_file is not None else None
        return CellContext(cell=cell, names=cell_names(cell), seed=seed)
    except DocumentError as error:
        return CellContext(cell=cell, seed=seed, mistake=error)
