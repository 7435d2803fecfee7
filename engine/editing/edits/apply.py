"""Applies edits to a text atomically: all of them or none."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from engine.editing.edits import edit, grouping, note_edits, transition_edits, type_replacement, ungrouping
from engine.editing.edits import field_edits as fields
from engine.editing.edits import node_edits as nodes
from engine.editing.edits import node_insertion as adding
from engine.editing.edits.edit_session import EditSession
from engine.editing.edits.type_losses import UnacceptedLosses
from engine.editing.project_context import ProjectContext
from engine.editing.text.draft import Draft, EditRefused
from engine.editing.text.outline import Outline
from engine.errors import DocumentError

MAX_TEXT = 2_000_000
_MAKERS: Mapping[type, Callable[[EditSession, Any], None]] = {
    edit.AddNode: adding.add_node,
    edit.RemoveNodes: nodes.remove_nodes,
    edit.RenameNode: nodes.rename_node,
    edit.MoveNodes: nodes.move_nodes,
    edit.SetTransition: transition_edits.set_transition,
    edit.ClearTransition: transition_edits.clear_transition,
    edit.SetInitial: transition_edits.set_initial,
    edit.SetParameter: fields.set_parameter,
    edit.ClearParameter: fields.clear_parameter,
    edit.SetField: fields.set_field,
    edit.SetPositions: fields.set_positions,
    edit.SetCanvasNote: note_edits.set_canvas_note,
    edit.GroupNodes: grouping.group,
    edit.UngroupNode: ungrouping.ungroup,
    edit.ReplaceType: type_replacement.replace_type,
    edit.DuplicateNodes: adding.duplicate,
    edit.PasteNodes: adding.paste,
    edit.SetDocument: fields.set_document,
    edit.AutoConnect: transition_edits.auto_connect,
}


@dataclass(frozen=True, kw_only=True)
class EditRefusal:
    """Why no edit was applied; `index` is the edit that failed, `losses` are those that it did not accept."""

    message: str
    hint: str
    index: int
    losses: tuple[edit.TypeLoss, ...] = ()


@dataclass(frozen=True, kw_only=True)
class EditedText:
    """A text after edits, with the paths of the nodes created or changed; unchanged if an edit was refused."""

    text: str
    changed: tuple[str, ...] = ()
    refused: EditRefusal | None = None


@dataclass(frozen=True, kw_only=True)
class EditResult(EditedText):
    """A text after edits; `draft` is the text as read, where edits were made, and `outline` its nodes."""

    draft: Draft | None = None
    outline: Outline | None = None


def apply_edits(text: str, edits: Sequence[edit.AnyEdit], *, file: str, context: ProjectContext) -> EditResult:
    """Apply edits in order; if one fails, the text stays unchanged.

    Args:
        text: YAML, or JSON if `file` ends in `.json`.
        edits: The edits to apply.
        file: Name of the document, for positions.
        context: The states and behaviors around it.
    """
    try:
        draft = Draft(text, file=file)
    except DocumentError as error:
        return EditResult(text=text, refused=EditRefusal(message=error.message, hint=error.hint or "", index=0))
    return apply_edits_to_draft(draft, edits, context=context)


def apply_edits_to_draft(
    draft: Draft, edits: Sequence[edit.AnyEdit], *, context: ProjectContext, outline: Outline | None = None
) -> EditResult:
    """Apply edits to a text that is parsed already; this consumes its `draft`, of which `outline` are the nodes."""
    index, text = 0, draft.given
    try:
        session = EditSession(draft, context, outline)
        for each in edits:
            _MAKERS[type(each)](session, each)
            index += 1
        changed = session.changed()
        made = draft.rewritten()
    except (EditRefused, DocumentError) as error:
        at = min(index, max(0, len(edits) - 1))
        losses = error.losses if isinstance(error, UnacceptedLosses) else ()
        return EditResult(
            text=text, refused=EditRefusal(message=error.message, hint=error.hint or "", index=at, losses=losses)
        )
    if len(made.given) > MAX_TEXT:
        refusal = EditRefusal(
            message="the edited document exceeds the size limit", hint="split it with behavior references", index=index
        )
        return EditResult(text=text, refused=refusal)
    now = session.outline
    if any(made.source_of(ref.data) is None for ref in now.refs.values()):
        now = Outline(made.data)  # with the data of new nodes as it was read back
    return EditResult(text=made.given, draft=made, outline=now, changed=changed)


def copy_nodes(text: str, paths: Sequence[str], *, file: str, context: ProjectContext) -> str:
    """Return nodes as YAML with their comments, each under its name.

    Raises:
        EditRefused: a path names no node.
        DocumentError: the text cannot be read.
    """
    return adding.copy_as_yaml(EditSession(Draft(text, file=file), context), list(paths))
