"""Behavior documents as frozen models: parameters, userdata, outcomes and a tree of nodes.

A node has exactly one kind key (`state`, `machine`, `concurrency` or `behavior`) and, beside it,
keys that hold for every kind (`transitions`, `timeout`, `retry`, `on_error`, `description`).
Mappings keep the order of the document, which is the order of precedence.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Literal

from msgspec import Meta

from engine.document.conversion import Strict
from engine.document.duration import Duration, seconds
from engine.document.parameter import Parameter
from engine.document.yaml_source import DataPath, Source
from engine.errors import Position

NodeKind = Literal["state", "machine", "concurrency", "behavior"]
KINDS: tuple[NodeKind, ...] = ("state", "machine", "concurrency", "behavior")

Key = Annotated[str, Meta(pattern="^[A-Za-z_][A-Za-z0-9_]{0,63}$", description="Letters, digits and `_`")]
NodeName = Annotated[
    str, Meta(pattern="^[A-Za-z0-9_][A-Za-z0-9_-]{0,63}$", description="Letters, digits, `_` and `-`, no `/`")
]
OutcomeName = Annotated[
    str, Meta(pattern="^[A-Za-z0-9_][A-Za-z0-9_-]{0,63}$", description="Letters, digits, `_` and `-`")
]
Reference = Annotated[str, Meta(min_length=1, description="A behavior file, relative to this document")]


class Timeout(Strict, frozen=True, kw_only=True):
    """Preempt the node `after` a duration and leave it for `to`.

    In a machine `to` is a sibling or an outcome of the machine; in a concurrency container it is
    the outcome that conditions see; at the root it is an outcome of the behavior.
    """

    after: Duration
    to: str

    @property
    def after_s(self) -> float:
        """The duration in seconds."""
        return seconds(self.after)


class Retry(Strict, frozen=True, kw_only=True):
    """Run the node again, up to `times` more, after these outcomes, and after errors when `errors`.

    The wait before the first repetition is `backoff`; it doubles each time.
    """

    times: Annotated[int, Meta(ge=1, le=1_000_000, description="How often to run it again, 1 or more")]
    backoff: Duration = 0.0
    outcomes: tuple[str, ...] = ()
    errors: bool = True

    @property
    def backoff_s(self) -> float:
        """The first wait in seconds."""
        return seconds(self.backoff)


class Machine(Strict, frozen=True, kw_only=True):
    """A state machine: one child at a time, from `initial` along the children's `transitions`."""

    initial: str
    states: Annotated[dict[NodeName, Node], Meta(min_length=1, description="The children, at least one")]
    userdata: dict[Key, object] = {}


class Condition(Strict, frozen=True, kw_only=True):
    """`outcome` is taken when every child in `when` has finished with the outcome named for it."""

    outcome: str
    when: Mapping[str, str]


class Concurrency(Strict, frozen=True, kw_only=True):
    """Children side by side; the first condition that holds decides the outcome."""

    states: Annotated[dict[NodeName, Node], Meta(min_length=1, description="The children, at least one")]
    conditions: tuple[
        Annotated[
            dict[OutcomeName, Annotated[dict[str, str], Meta(min_length=1, description="`{child: outcome}`")]],
            Meta(min_length=1, max_length=1, description="`{outcome: {child: outcome, …}}`"),
        ],
        ...,
    ]
    otherwise: str | None = None
    userdata: dict[Key, object] = {}

    @property
    def rules(self) -> tuple[Condition, ...]:
        """The conditions in order of precedence."""
        return tuple(Condition(outcome=name, when=when) for entry in self.conditions for name, when in entry.items())


class Node(Strict, frozen=True, kw_only=True, rename={"parameters": "with", "inputs": "in", "outputs": "out"}):
    """One node: its kind, its wiring into the enclosing container, and what to do when it fails.

    `parameters` (`with:`) go to a state or behavior; text in them may hold `${…}` expressions.
    `inputs` (`in:`) maps input keys of the state or behavior to userdata keys that can be read
    here, `outputs` (`out:`) maps output keys to the userdata keys that they are written to.
    """

    state: str | None = None
    machine: Machine | None = None
    concurrency: Concurrency | None = None
    behavior: Reference | None = None
    parameters: dict[str, object] = {}
    inputs: dict[str, Key] = {}
    outputs: dict[str, Key] = {}
    transitions: dict[str, str] = {}
    timeout: Timeout | None = None
    retry: Retry | None = None
    on_error: str | None = None
    description: str = ""

    @property
    def kind(self) -> NodeKind:
        """The key that says what the node is."""
        if self.state is not None:
            return "state"
        if self.machine is not None:
            return "machine"
        return "concurrency" if self.concurrency is not None else "behavior"

    @property
    def children(self) -> Mapping[str, Node]:
        """The nodes inside a machine or concurrency container, in document order."""
        container = self.machine or self.concurrency
        return container.states if container is not None else {}

    @property
    def userdata(self) -> Mapping[str, object]:
        """The initial values of the container's own scope."""
        container = self.machine or self.concurrency
        return container.userdata if container is not None else {}


class BehaviorDocument(Strict, frozen=True, kw_only=True):
    """A behavior as written. `view` holds canvas positions by node path and has no meaning."""

    flexcell: Literal[1]
    name: Annotated[str, Meta(min_length=1, max_length=128, description="What people call it")]
    description: str = ""
    parameters: dict[Key, Parameter] = {}
    userdata: dict[Key, object] = {}
    outcomes: Annotated[tuple[OutcomeName, ...], Meta(min_length=1, description="How it can end, at least one")]
    success: Annotated[tuple[OutcomeName, ...], Meta(description="The outcomes that mean success")] = ()
    cell: Annotated[str, Meta(min_length=1, description="The cell it runs in, relative to this document")] | None = None
    root: Node
    view: dict[str, tuple[float, float]] = {}


@dataclass(frozen=True, kw_only=True)
class Behavior:
    """A behavior document with its file, its positions and the behaviors it refers to."""

    document: BehaviorDocument
    file: Path
    meaning: str
    """SHA-256 of what the document and its references mean: without `view`, comments, formatting."""
    references: Mapping[str, Behavior] = field(default_factory=dict[str, "Behavior"])
    """The behaviors referred to, by the path as written in `behavior:`."""
    source: Source = field(repr=False)

    @property
    def name(self) -> str:
        """What people call it."""
        return self.document.name

    @property
    def root(self) -> Node:
        """The outermost node; its path is `root`."""
        return self.document.root

    @property
    def parameters(self) -> Mapping[str, Parameter]:
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

    def nodes(self) -> Iterator[tuple[str, Node]]:
        """Go through (path, node) in document order, containers before their children."""
        return walk("root", self.root)

    def position(self, path: str, *keys: str | int) -> Position:
        """Return where the node at `path` (`root/approach/left`) stands, or a value inside it.

        Args:
            path: The node; where it is absent, the nearest ancestor is given.
            keys: Keys as written, from the node inward, e.g. `"with", "speed"`.
        """
        return self.source.position((*self._data_path(path), *keys), of_key=not keys)

    def key_position(self, path: str, *keys: str | int) -> Position:
        """Return where a key inside the node at `path` stands."""
        return self.source.position((*self._data_path(path), *keys), of_key=True)

    def _data_path(self, path: str) -> DataPath:
        steps: list[str | int] = ["root"]
        node = self.root
        for name in path.split("/")[1:]:
            if name not in node.children:
                break
            steps += [node.kind, "states", name]
            node = node.children[name]
        return tuple(steps)


def walk(path: str, node: Node) -> Iterator[tuple[str, Node]]:
    """Go through (path, node) of a node and everything inside it, in document order."""
    due = [(path, node)]
    while due:
        here, current = due.pop()
        yield here, current
        due += [(f"{here}/{name}", child) for name, child in reversed(list(current.children.items()))]
