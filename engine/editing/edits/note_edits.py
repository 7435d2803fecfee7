"""Edits of the free notes on the canvas of a container."""

from __future__ import annotations

from typing import cast

from engine.editing.edits.edit import SetCanvasNote
from engine.editing.edits.edit_session import EditSession
from engine.editing.edits.field_edits import rounded
from engine.editing.text.draft import EditRefused
from engine.editing.text.node_matching import graft
from engine.editing.text.outline import Plain
from engine.wording.suggestions import did_you_mean

CANVAS_NOTES = "canvas_notes"


def set_canvas_note(session: EditSession, edit: SetCanvasNote) -> None:
    """Add, change or remove a note on the canvas of a container."""
    ref = session.at(edit.path)
    notes = all_notes(session)
    inside = _mapping(notes.get(ref.path))
    if edit.note is not None:
        written: Plain = {
            "text": edit.note.text,
            "position": [rounded(number) for number in edit.note.position],
            "size": [rounded(number) for number in edit.note.size],
            "colour": edit.note.colour,
        }
        inside[edit.name] = graft(inside[edit.name], written) if edit.name in inside else written
    elif edit.name in inside:
        del inside[edit.name]
    else:
        hint = did_you_mean(edit.name, inside)
        raise EditRefused(f"there is no note `{edit.name}` on the canvas of `{ref.path}`", hint=hint)
    put_notes(session, ref.path, inside)
    session.mark(ref.data)


def move_notes(session: EditSession, notes: Plain, to: str, corner: tuple[float, float]) -> None:
    """Put the notes of a container that is gone on the canvas of the one around it, at the places where they were.

    Args:
        session: The document.
        notes: The notes, by name.
        to: The path of the container around.
        corner: Where the former container was in it, in pixels.
    """
    inside = _mapping(all_notes(session).get(to))
    for name, note in notes.items():
        number, free = 2, name
        while free in inside:
            free, number = f"{name}_{number}", number + 1
        position = _mapping(note).get("position")
        if isinstance(position, list) and len(cast("list[float]", position)) == 2:
            x, y = cast("list[float]", position)
            _mapping(note)["position"] = [rounded(x + corner[0]), rounded(y + corner[1])]
        inside[free] = note
    put_notes(session, to, inside)


def all_notes(session: EditSession) -> Plain:
    """Return the notes of all containers, by path."""
    return _mapping(session.draft.data.get(CANVAS_NOTES))


def put_notes(session: EditSession, path: str, inside: Plain) -> None:
    """Write the notes of one container; without any, its entry goes, and the key with the last entry."""
    notes = all_notes(session)
    if inside:
        notes[path] = inside
    else:
        notes.pop(path, None)
    if notes:
        session.draft.data[CANVAS_NOTES] = notes
    else:
        session.draft.data.pop(CANVAS_NOTES, None)


def _mapping(value: object) -> Plain:
    return cast("Plain", value) if isinstance(value, dict) else {}
