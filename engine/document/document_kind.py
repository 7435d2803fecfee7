"""Which kind of document parsed data are, by their keys."""

from __future__ import annotations

from functools import cache
from typing import cast

from engine.document.text.yaml_source import DocumentSource
from engine.errors import DocumentError, Position

_INSTEAD = {
    "behavior": "give a behavior, which has `root:`; a cell is named by `--cell`, or by `cell:` of the behavior",
    "cell": "give the document of a cell; a behavior is run in it: flexcell run BEHAVIOR --cell CELL",
}


def kind_of(data: object) -> str | None:
    """Return the kind of the data of a document: behavior, cell, module, and so on; None for none of them."""
    if not isinstance(data, dict):
        return None
    keys = cast("dict[str, object]", data)
    return next((kind for key, kind in _kinds() if key in keys), None)


@cache
def _kinds() -> tuple[tuple[str, str], ...]:
    """Return keys with the kind that they tell, in this order: a behavior may name its cell, a sweep both."""
    # Imported here: only a document that is refused needs the kinds of entries.
    from engine.document.entries_document import SECTIONS

    return (
        ("root", "behavior"),
        ("outcomes", "behavior"),
        ("behavior", "sweep"),
        ("cell", "cell"),
        ("module", "module"),
        ("equipment", "equipment"),
        ("pin_configs", "equipment"),
        *((key, "entries") for key in SECTIONS.values()),
        ("faults", "faults"),
        ("substitutes", "substitutes"),
    )


def require_kind(source: DocumentSource, kind: str) -> None:
    """Refuse a document of another kind; what is of none may be one with mistakes.

    Raises:
        DocumentError: it is of another kind, which the message names.
    """
    found = kind_of(source.data)
    if found not in (None, kind):
        article = "an" if found[:1] in "aeiou" else "a"
        where = Position(file=source.file, line=1, column=1)
        raise DocumentError(f"this is {article} {found} document, not a {kind}", where=where, hint=_INSTEAD[kind])
