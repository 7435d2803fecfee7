"""`flexcell schema`: the JSON Schemas of documents, for editors."""

from __future__ import annotations

import sys
from typing import Annotated, Literal

import typer

from engine.document.schema import schema_texts


def schema(
    kind: Annotated[
        Literal["behavior", "cell", "entries", "faults", "substitutes"], typer.Argument(help="Which document.")
    ] = "behavior",
) -> None:
    """Print the JSON Schema of a kind of document."""
    sys.stdout.write(schema_texts()[f"{kind}.schema.json"])
