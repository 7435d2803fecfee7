"""Behavior documents as frozen models: parameters, userdata, outcomes and a tree of nodes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from hashlib import sha256
from pathlib import Path
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from engine.document.canvas_note import CanvasNote, NoteName
from engine.document.nodes.node_kind import OutcomeName
from engine.document.nodes.node_spec import Key, NodeSpec
from engine.document.parameter_spec import ParameterSpec
from engine.document.substitutes import Substitutes
from engine.document.text.decoding import StrictModel
from engine.document.text.document_file import DocumentFile
from engine.document.text.yaml_source import DataPath
from engine.errors import Position


class BehaviorDocument(StrictModel, frozen=True, kw_only=True):
    """A behavior as written.

    `view` (canvas positions), `notes` and `canvas_notes`, by node path, do not affect a run.
    """

    flexcell: Literal[1]
    name: Annotated[str, Meta(min_length=1, max_length=128, description="Display name")]
    description: str = ""
    parameters: dict[Key, ParameterSpec] = {}
    userdata: dict[Key, object] = {}
    outcomes: Annotated[tuple[OutcomeName, ...], Meta(min_length=1, description="Possible outcomes, at least one")]
    success: Annotated[tuple[OutcomeName, ...], Meta(description="The outcomes that mean success")] = ()
    cell: Annotated[str, Meta(min_length=1, description="The cell it runs in, relative to this document")] | None = None
    root: NodeSpec
    view: dict[str, tuple[float, float]] = {}
    notes: dict[str, str] = {}
    canvas_notes: dict[str, dict[NoteName, CanvasNote]] = {}


# No slots: cached properties need a `__dict__`.
@dataclass(frozen=True, kw_only=True)
class Behavior(DocumentFile[BehaviorDocument]):
    """A behavior document with its file, its positions and the behaviors it refers to."""

    references: Mapping[str, Behavior] = field(default_factory=dict[str, "Behavior"])
    """The behaviors referred to, by the path as written in `behavior:`."""
    classes: Mapping[str, type] = field(default_factory=dict[str, type], repr=False, compare=False)
    """The classes passed from Python, by their `module:Class`; empty for a behavior from a document."""
    substitutes: Substitutes | None = field(default=None, repr=False)
    """The substitutes for some of its nodes, in a test."""
    gaps: Mapping[str, frozenset[str]] = field(default_factory=dict[str, frozenset[str]], repr=False, compare=False)
    """Unreadable keys in a behavior that can only be checked, by the path of their node; the empty path is the behavior
    itself, the empty key an unknown key. Empty for a behavior that can be run."""

    @cached_property
    def meaning(self) -> str:
        """Semantic hash (SHA-256) of document, references and substitutes; the order of nodes and parameters counts.

        Formatting, comments, canvas positions and notes do not.
        """
        document = self.document
        order = [list(document.parameters), *(list(node.children) for _, node in self.nodes())]
        references = {written: referred.meaning for written, referred in self.references.items()}
        digest = sha256()
        for part in (msgspec.structs.replace(document, view={}, notes={}, canvas_notes={}), order, references):
            digest.update(msgspec.json.encode(part, order="sorted"))
            digest.update(b"\n")
        if self.substitutes is None:
            return digest.hexdigest()
        return sha256(digest.hexdigest().encode() + self.substitutes.text).hexdigest()

    @property
    def name(self) -> str:
        """The display name."""
        return self.document.name

    @property
    def root(self) -> NodeSpec:
        """The outermost node; its path is `root`."""
        return self.document.root

    @property
    def parameters(self) -> Mapping[str, ParameterSpec]:
        """The parameters of a run, by name."""
        return self.document.parameters

    @property
    def outcomes(self) -> tuple[str, ...]:
        """The possible outcomes."""
        return self.document.outcomes

    @property
    def success(self) -> tuple[str, ...]:
        """The outcomes that mean success."""
        return self.document.success

    @property
    def cell_file(self) -> Path | None:
        """The default cell; None if the document names none."""
        cell = self.document.cell
        return (self.file.parent / cell).resolve() if cell is not None else None

    def with_substitutes(self, substitutes: Substitutes | None) -> Behavior:
        """Return the behavior with substitutes and another semantic hash; the behavior itself for None."""
        return replace(self, substitutes=substitutes) if substitutes is not None else self

    def nodes(self) -> tuple[tuple[str, NodeSpec], ...]:
        """Return (path, node) in document order, containers before their children."""
        return self.root.nodes_as_root

    def position(self, path: str, *keys: str | int) -> Position:
        """Return the position of the node at `path` (`root/approach/left`), or of a value inside it.

        Args:
            path: The node; if it does not exist, the position of the nearest ancestor is returned.
            keys: Keys as written, from the node inward, e.g. `"with", "speed"`.
        """
        return self.source.position((*self.data_path(path), *keys), of_key=not keys)

    def key_position(self, path: str, *keys: str | int) -> Position:
        """Return the position of a key inside the node at `path`."""
        return self.source.position((*self.data_path(path), *keys), of_key=True)

    def data_path(self, path: str) -> DataPath:
        """Return the keys from the document inward to the node at `path`, or to its nearest ancestor."""
        steps: list[str | int] = ["root"]
        node = self.root
        for name in path.split("/")[1:]:
            if name not in node.children:
                break
            steps += node.child_keys(name)
            node = node.children[name]
        return tuple(steps)
