"""Substitutes documents: replacements of nodes of a behavior, so that the rest can be tested.

    flexcell: 1
    substitutes:
      - {at: root/*/grasp, outcome: held, after: 2 s, outputs: {width_m: 0.03}}
      - {at: root/detect, script: [{outcome: none}, {error: the camera is dark}, {outcome: found}]}
      - {at: root/**/plan, state: "my_states:PlanNothing"}

A replaced node of any kind keeps its connections but is not executed. The first entry that matches a node applies.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from engine.document.duration import Duration, seconds
from engine.document.nodes.node_spec import Key
from engine.document.path_pattern import PathPattern, matches
from engine.document.text.decoding import StrictModel, decode_document
from engine.document.text.document_file import DocumentFile
from engine.document.text.yaml_source import DocumentSource, load_source, parse_source
from engine.errors import DocumentError, Position


class SubstituteEnding(StrictModel, frozen=True, kw_only=True):
    """How one activation of a node ends: with an outcome and its outputs, or an error, `after` a time.

    `outputs` are those of the replaced state or behavior; of a container they are userdata keys.
    """

    outcome: str | None = None
    after: Duration = 0.0
    outputs: dict[Key, object] = {}
    error: Annotated[str, Meta(min_length=1, description="Error message")] | None = None

    @property
    def after_s(self) -> float:
        """Duration in seconds."""
        return seconds(self.after)


class Substitute(SubstituteEnding, frozen=True, kw_only=True):
    """The replacement of the nodes `at`: an ending, a `script` of endings, or another `state`.

    A script has one ending for each activation, in order; the last one applies to all further activations. Another
    state gets the parameters `with`, or those of the replaced state, and has no outcomes that this one lacks.
    """

    at: PathPattern
    script: tuple[SubstituteEnding, ...] = ()
    state: Annotated[str, Meta(min_length=1, description="The name of a state")] | None = None
    parameters: dict[str, object] | None = msgspec.field(default=None, name="with")

    @property
    def endings(self) -> tuple[SubstituteEnding, ...]:
        """The endings of the script, or the single ending."""
        return self.script or (
            SubstituteEnding(outcome=self.outcome, after=self.after, outputs=self.outputs, error=self.error),
        )


class SubstitutesDocument(StrictModel, frozen=True, kw_only=True):
    """The substitutes of a run as written, in order of precedence."""

    flexcell: Literal[1]
    description: str = ""
    substitutes: Annotated[tuple[Substitute, ...], Meta(min_length=1, description="The substitutes, at least one")]


@dataclass(frozen=True, kw_only=True)
class Substitutes(DocumentFile[SubstitutesDocument]):
    """A substitutes document with its file."""

    classes: Mapping[str, type] = field(default_factory=dict[str, type], repr=False, compare=False)
    """The state classes passed by a test, by their names; empty for a document."""

    def position(self, index: int, *keys: str | int) -> Position:
        """Return the position of an entry, from 0, or of a value inside it."""
        return self.source.position(("substitutes", index, *keys))

    def index_for(self, path: str) -> int | None:
        """Return the index of the entry that replaces a node; None without one."""
        entries = enumerate(self.document.substitutes)
        return next((index for index, entry in entries if matches(entry.at, path)), None)

    @property
    def text(self) -> bytes:
        """The document, without its comments."""
        return msgspec.json.encode(self.document)


def load_substitutes(path: Path | str) -> Substitutes:
    """Read a substitutes document.

    Raises:
        DocumentError: the file cannot be read or is not valid; `where` is the position.
    """
    return _checked(load_source(Path(path)), Path(path))


def parse_substitutes(text: bytes | str, *, file: Path | str) -> Substitutes:
    """Return the substitutes that `text` describes; `file` is the name shown in positions.

    Raises:
        DocumentError: as `load_substitutes`.
    """
    return _checked(parse_source(text, file=str(file)), Path(file))


def new_substitutes(entries: Iterable[Substitute], *, name: str = "substitutes") -> Substitutes:
    """Return substitutes built in Python; `name` is shown instead of a file.

    Raises:
        DocumentError: as `load_substitutes`.
    """
    document = SubstitutesDocument(flexcell=1, substitutes=tuple(entries))
    return parse_substitutes(msgspec.json.encode(document), file=name)


def _checked(source: DocumentSource, file: Path) -> Substitutes:
    document = decode_document(source, SubstitutesDocument)
    for index, entry in enumerate(document.substitutes):
        _require_one_kind(source, index, entry)
        for number, ending in enumerate(entry.script):
            _require_one_end(source, ("substitutes", index, "script", number), ending)
        if not entry.script and entry.state is None:
            _require_one_end(source, ("substitutes", index), entry)
    return Substitutes(document=document, file=file, source=source)


def _require_one_kind(source: DocumentSource, index: int, entry: Substitute) -> None:
    written = [key for key in ("outcome", "error", "script", "state") if getattr(entry, key) not in (None, ())]
    if len(written) > 1:
        where = source.position(("substitutes", index, written[1]), of_key=True)
        message = f"this substitute has both `{written[0]}` and `{written[1]}`"
        raise DocumentError(message, where=where, hint="keep one of them")
    excluded = ("after", "outputs") if entry.script or entry.state is not None else ()
    unused = [key for key in excluded if getattr(entry, key)]
    unused += ["with"] if entry.parameters is not None and entry.state is None else []
    if unused:
        where = source.position(("substitutes", index, unused[0]), of_key=True)
        hint = "`with` requires `state`; `after` and `outputs` require an `outcome`"
        raise DocumentError(f"`{unused[0]}` has no effect here", where=where, hint=hint)


def _require_one_end(source: DocumentSource, keys: tuple[str | int, ...], ending: SubstituteEnding) -> None:
    if (ending.outcome is None) == (ending.error is None):
        hint = "set one of `outcome` and `error`" + ("" if len(keys) > 2 else ", a `script` or a `state`")
        raise DocumentError("this substitute has no ending", where=source.position(keys), hint=hint)
    if ending.error is not None and ending.outputs:
        where = source.position((*keys, "outputs"), of_key=True)
        raise DocumentError("an error has no outputs", where=where, hint="remove `outputs`")
