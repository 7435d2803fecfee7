"""Behavior documents as frozen models: parameters, userdata, outcomes and a tree of nodes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from hashlib import sha256
from pathlib import Path
from typing import Annotated, Literal

from msgspec import Meta

from engine.document.decoding import StrictModel
from engine.document.node_kind import OutcomeName
from engine.document.node_spec import Key, NodeSpec
from engine.document.parameter_spec import ParameterSpec
from engine.document.substitutes import Substitutes
from engine.document.yaml_source import DataPath, DocumentSource
from engine.errors import Position


class BehaviorDocument(StrictModel, frozen=True, kw_only=True):
    """A behavior as written. `view` (canvas positions) and `notes`, by node path, have no meaning."""

    flexcell: Literal[1]
    name: Annotated[str, Meta(min_length=1, max_length=128, description="What people call it")]
    description: str = ""
    parameters: dict[Key, ParameterSpec] = {}
    userdata: dict[Key, object] = {}
    outcomes: Annotated[tuple[OutcomeName, ...], Meta(min_length=1, description="How it can end, at least one")]
    success: Annotated[tuple[OutcomeName, ...], Meta(description="The outcomes that mean success")] = ()
    cell: Annotated[str, Meta(min_length=1, description="The cell it runs in, relative to this document")] | None = None
    root: NodeSpec
    view: dict[str, tuple[float, float]] = {}
    notes: dict[str, str] = {}


@dataclass(frozen=True, kw_only=True)
class Behavior:
    """A behavior document with its file, its positions and the behaviors it refers to."""

    document: BehaviorDocument
    file: Path
    meaning: str
    """SHA-256 of what the document and its references mean: without `view`, `notes`, comments, formatting."""
    references: Mapping[str, Behavior] = field(default_factory=dict[str, "Behavior"])
    """The behaviors referred to, by the path as written in `behavior:`."""
    source: DocumentSource = field(repr=False)
    classes: Mapping[str, type] = field(default_factory=dict[str, type], repr=False, compare=False)
    """The classes that Python gave it, by the `module:Class` written for each; a document brings none."""
    substitutes: Substitutes | None = field(default=None, repr=False)
    """What stands in for some of its nodes, in a test."""
    gaps: Mapping[str, frozenset[str]] = field(default_factory=dict[str, frozenset[str]], repr=False, compare=False)
    """What could not be read, in a behavior that is only to be checked: keys by the path of their node, or by an empty
    one where they are the behavior's own; an empty key where nobody knows which. None of a behavior that may be run."""

    @property
    def name(self) -> str:
        """What people call it."""
        return self.document.name

    @property
    def root(self) -> NodeSpec:
        """The outermost node; its path is `root`."""
        return self.document.root

    @property
    def parameters(self) -> Mapping[str, ParameterSpec]:
        """What a run may be given, by name."""
        return self.document.parameters

    @property
    def outcomes(self) -> tuple[str, ...]:
        """How it can end."""
        return self.document.outcomes

    @property
    def success(self) -> tuple[str, ...]:
        """The outcomes that mean success."""
        return self.document.success

    @property
    def cell_file(self) -> Path | None:
        """The cell it runs in unless another is given; None where it names none."""
        cell = self.document.cell
        return (self.file.parent / cell).resolve() if cell is not None else None

    def with_substitutes(self, substitutes: Substitutes | None) -> Behavior:
        """Return the behavior with stand-ins, which does not mean the same any more; itself for none."""
        if substitutes is None:
            return self
        meaning = sha256(self.meaning.encode() + substitutes.text).hexdigest()
        return replace(self, substitutes=substitutes, meaning=meaning)

    def nodes(self) -> Iterator[tuple[str, NodeSpec]]:
        """Go through (path, node) in document order, containers before their children."""
        return walk("root", self.root)

    def position(self, path: str, *keys: str | int) -> Position:
        """Return where the node at `path` (`root/approach/left`) stands, or a value inside it.

        Args:
            path: The node; where it is absent, the nearest ancestor is given.
            keys: Keys as written, from the node inward, e.g. `"with", "speed"`.
        """
        return self.source.position((*self.data_path(path), *keys), of_key=not keys)

    def key_position(self, path: str, *keys: str | int) -> Position:
        """Return where a key inside the node at `path` stands."""
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


def walk(path: str, node: NodeSpec) -> Iterator[tuple[str, NodeSpec]]:
    """Go through (path, node) of a node and everything inside it, in document order."""
    due = [(path, node)]
    while due:
        here, current = due.pop()
        yield here, current
        due += [(f"{here}/{name}", child) for name, child in reversed(list(current.children.items()))]
