"""Applies edits to a text: all of them or none, and nothing but what they ask for."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, cast

import msgspec

from engine.document.conversion import in_words
from engine.editing import adding, edit, fields, grouping, nodes, ungrouping, wiring
from engine.editing.bench import Bench
from engine.editing.draft import Draft, EditRefused
from engine.editing.knowledge import Knowledge
from engine.errors import DocumentError

MAX_TEXT = 2_000_000
_MAKERS: Mapping[type, Callable[[Bench, Any], None]] = {
    edit.AddNode: adding.add_node,
    edit.RemoveNodes: nodes.remove_nodes,
    edit.RenameNode: nodes.rename_node,
    edit.MoveNodes: nodes.move_nodes,
    edit.SetTransition: wiring.set_transition,
    edit.ClearTransition: wiring.clear_transition,
    edit.SetInitial: wiring.set_initial,
    edit.SetParameter: fields.set_parameter,
    edit.ClearParameter: fields.clear_parameter,
    edit.SetField: fields.set_field,
    edit.SetPositions: fields.set_positions,
    edit.Group: grouping.group,
    edit.Ungroup: ungrouping.ungroup,
    edit.Duplicate: adding.duplicate,
    edit.Paste: adding.paste,
    edit.SetDocument: fields.set_document,
    edit.AutoConnect: wiring.auto_connect,
}


@dataclass(frozen=True, kw_only=True)
class Refusal:
    """Why no edit was made: `index` says which of them could not be."""

    message: str
    hint: str
    index: int


@dataclass(frozen=True, kw_only=True)
class Edited:
    """A text after edits, and the paths of the nodes that they made or changed; where refused, as it was.

    `draft` is the text as read, where edits were made.
    """

    text: str
    draft: Draft | None = None
    changed: tuple[str, ...] = ()
    refused: Refusal | None = None


def read_edits(raw: Sequence[object]) -> tuple[list[edit.AnyEdit], Refusal | None]:
    """Return edits from plain data, or which of them is none."""
    made: list[edit.AnyEdit] = []
    for index, each in enumerate(raw):
        try:
            made.append(cast("edit.AnyEdit", msgspec.convert(each, cast("Any", edit.AnyEdit))))
        except msgspec.ValidationError as error:
            return [], Refusal(
                message=f"this is no edit: {in_words(str(error))}", hint="see the list of edits", index=index
            )
    return made, None


def apply_edits(text: str, edits: Sequence[edit.AnyEdit], *, file: str, knowledge: Knowledge) -> Edited:
    """Apply edits one after the other; the first that cannot be made leaves the text as it was.

    Args:
        text: YAML, or JSON where `file` ends so.
        edits: What to do.
        file: Name of the document, for positions.
        knowledge: The states and behaviors around it.
    """
    try:
        draft = Draft(text, file=file)
    except DocumentError as error:
        return Edited(text=text, refused=Refusal(message=error.message, hint=error.hint or "", index=0))
    return apply_to(draft, edits, knowledge=knowledge)


def apply_to(draft: Draft, edits: Sequence[edit.AnyEdit], *, knowledge: Knowledge) -> Edited:
    """Apply edits to a text that was read already; its `draft` is used up."""
    index, text = 0, draft.given
    try:
        bench = Bench(draft, knowledge)
        for each in edits:
            _MAKERS[type(each)](bench, each)
            bench.stale()
            index += 1
        made = draft.rewritten()
    except (EditRefused, DocumentError) as error:
        return Edited(
            text=text,
            refused=Refusal(message=error.message, hint=error.hint or "", index=min(index, max(0, len(edits) - 1))),
        )
    if len(made.given) > MAX_TEXT:
        refusal = Refusal(
            message="the document would become too large", hint="split it with behavior references", index=index
        )
        return Edited(text=text, refused=refusal)
    return Edited(text=made.given, draft=made, changed=bench.changed())


def copy_nodes(text: str, paths: Sequence[str], *, file: str, knowledge: Knowledge) -> str:
    """Return nodes as YAML with their comments, each under its name.

    Raises:
        EditRefused: a path names no node.
        DocumentError: the text cannot be read.
    """
    return adding.copied_yaml(Bench(Draft(text, file=file), knowledge), list(paths))
