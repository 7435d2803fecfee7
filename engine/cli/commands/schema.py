"""`flexcell schema`: prints the JSON Schemas of documents, for text editors."""

from __future__ import annotations

import sys
from typing import Annotated, Literal

import typer

from engine.cell.drivers import cell_schema_text
from engine.document.schema import schema_texts


def schema(
    kind: Annotated[
        Literal["behavior", "cell", "entries", "equipment", "faults", "module", "substitutes", "sweep"],
        typer.Argument(help="Kind of document."),
    ] = "behavior",
) -> None:
    """Print the JSON Schema of a kind of document; that of a cell has the options of the installed drivers."""
    sys.stdout.write(cell_schema_text() if kind == "cell" else schema_texts()[f"{kind}.schema.json"])
