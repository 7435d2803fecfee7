"""The saved behaviors of a project that name an item of its cell: what a new name of the item leaves behind."""

from __future__ import annotations

from engine.document.cell import Cell
from engine.editing.adaptation.name_uses import NameUses, SignatureOf
from engine.editing.referring_behavior import ReferringBehavior
from engine.errors import FlexcellError
from engine.library.behavior_library import Library


def behaviors_naming(
    name: str, *, cell: Cell, library: Library, signature_of: SignatureOf
) -> tuple[ReferringBehavior, ...]:
    """Return the behaviors for this cell that name an item, or what stands on it if it is a module, by their ids.

    Args:
        name: The name of the item.
        cell: The open cell.
        library: The saved behaviors.
        signature_of: Returns the signature of a state by its name.
    """
    reader, file = NameUses(cell, signature_of), cell.file.resolve()
    found: list[ReferringBehavior] = []
    for view in library.views():
        try:
            behavior = library.behavior(view.id)
        except FlexcellError:
            continue  # the list of behaviors reports the problem
        if behavior.cell_file is None or behavior.cell_file.resolve() != file:
            continue
        uses = (use for use in reader.of(behavior) if use.name == name or use.name.startswith(f"{name}/"))
        paths = tuple(dict.fromkeys(use.path for use in uses))
        if paths:
            found.append(ReferringBehavior(id=view.id, name=view.name, paths=paths))
    return tuple(sorted(found, key=lambda each: each.id))
