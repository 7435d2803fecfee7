"""JSON bodies of the editor: documents as text with their graph, their versions, and the catalogue."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from editor_web.http_bodies.common_bodies import ErrorBody, FindingBody, GraphNodeBody, HttpBody, TransitionBody
from engine.document.yaml_source import MAX_BYTES

Text = Annotated[str, Field(max_length=MAX_BYTES)]
Hash = Annotated[str, Field(pattern="^[0-9a-f]{64}$")]
Path = Annotated[str, Field(max_length=4000)]
Id = Annotated[str, Field(max_length=300)]
CanvasPosition = tuple[float, float]


class RuleBody(HttpBody):
    """One rule of a concurrency container: the outcome, and the outcomes of children that it needs, all or `at_least`.

    A rule that preempts some children has no outcome.
    """

    outcome: str
    when: dict[str, str]
    at_least: int | None
    preempt: tuple[str, ...]


class DocumentNodeBody(GraphNodeBody):
    """One node as written: the fields of a run's graph and all raw fields of the form; lines and columns count from 1.

    `targets` are its own transitions, outcome to target; `exits` are the outcomes without a transition. `settings` are
    the remaining keys of its kind, such as `memory` or `times`. `document` is the id of the behavior it refers to.
    `role` is its key in the parent node, such as `then`.
    """

    children: tuple[DocumentNodeBody, ...]  # pyright: ignore[reportIncompatibleVariableOverride]
    label: str
    role: str
    description: str
    line: int
    column: int
    end_line: int
    state: str | None
    reference: str | None
    document: str | None
    parameters: dict[str, object]
    inputs: dict[str, str]
    outputs: dict[str, str]
    targets: dict[str, str]
    exits: tuple[str, ...]
    autonomy: dict[str, str]
    timeout: dict[str, object] | None
    retry: dict[str, object] | None
    guard: dict[str, object] | None
    post: dict[str, object] | None
    on_error: str | None
    resume: str | None
    success: tuple[str, ...]
    every: object
    notes: str
    position: CanvasPosition | None
    rules: tuple[RuleBody, ...]
    otherwise: str | None
    userdata: dict[str, object]
    settings: dict[str, object]


class DocumentInfoBody(HttpBody):
    """The declarations of the document itself, as written."""

    name: str
    description: str
    cell: str | None
    parameters: dict[str, dict[str, object]]
    userdata: dict[str, object]
    outcomes: tuple[str, ...]
    success: tuple[str, ...]


class DraftResultBody(HttpBody):
    """The graph and findings of a text; `graph` and `document` are null if the text cannot be read.

    `checked` is false if the request did not ask for findings; the route `findings` returns them.
    """

    hash: str
    graph: DocumentNodeBody | None
    document: DocumentInfoBody | None
    findings: tuple[FindingBody, ...]
    checked: bool


class DocumentBody(DraftResultBody):
    """A document on disk; `saved_at` is the time of its last change, seconds since 1970."""

    id: str
    text: str
    saved_at: float


class EditRefusalBody(HttpBody):
    """Why no edit was applied: `index` is the edit that failed."""

    message: str
    hint: str
    index: int


class GraphDifferenceBody(HttpBody):
    """How the graph of the text with the hash `base` becomes another one; nodes are named by path.

    `nodes` are those that are new or say something else, without children, transitions and lines. `children` are the
    names of all children, in order, where these changed; a node that is no child any more is gone. `arrows` are the
    transitions between children of a node, by the child that they leave, where they changed. `shifts` are pairs of a
    line of the old graph and a number of lines by which everything from there on moved; `lines` are line, column and
    last line of all other nodes.
    """

    base: Hash
    nodes: dict[str, DocumentNodeBody]
    children: dict[str, tuple[str, ...]]
    arrows: dict[str, dict[str, tuple[TransitionBody, ...]]]
    shifts: tuple[tuple[int, int], ...]
    lines: dict[str, tuple[int, int, int]]


class EditResultBody(DraftResultBody):
    """The text after the edits, and the nodes that they created or changed; the unchanged text if refused.

    With a `difference` there is no `graph`.
    """

    text: str
    changed: tuple[str, ...]
    refused: EditRefusalBody | None
    difference: GraphDifferenceBody | None = None


class CopyResultBody(HttpBody):
    """Nodes as YAML, ready to paste."""

    yaml: str


class TextBody(HttpBody):
    """A text under edit."""

    text: Text


class TargetsBody(TextBody):
    """A text whose targets are checked; a newer request of the same page replaces the pending one."""

    page: Annotated[str, Field(max_length=40)]


class TargetFindingsBody(HttpBody):
    """The targets that an arm of the document's cell cannot reach.

    `dropped` is true if the page has sent a newer text; `problem` tells why the targets could not be checked.
    """

    findings: tuple[FindingBody, ...] = ()
    problem: str = ""
    dropped: bool = False


class DraftBody(TextBody):
    """A text to draw; without `check` the response is faster and has no findings."""

    check: bool = True


class EditsBody(DraftBody):
    """A text and the edits to apply, all or none; the edits are those of `engine.editing.edit`.

    `graph` is the hash of the text whose graph the page has; the answer then has only the difference, if the server
    knows that graph too.
    """

    edits: Annotated[list[dict[str, object]], Field(max_length=500)]
    graph: Hash | None = None


class CopyBody(TextBody):
    """A text and the nodes to copy from it."""

    paths: Annotated[list[Path], Field(max_length=1000)]


class SaveBody(TextBody):
    """A text to write, and the hash of the version it is based on."""

    base_hash: Hash


class SaveResultBody(HttpBody):
    """The version that is on disk now."""

    hash: str
    saved_at: float


class MergeConflictBody(HttpBody):
    """Lines that both sides changed differently; `line` is their position in the text to save."""

    line: int
    base: str
    ours: str
    theirs: str


class ConflictBody(ErrorBody):
    """The document has changed on disk; `merged` has both changes, null if they conflict."""

    theirs: str
    theirs_hash: str
    merged: str | None
    conflicts: tuple[MergeConflictBody, ...]


class NewDocumentBody(HttpBody):
    """A document to create from a template: machine, sequence or concurrency."""

    id: Id
    name: Annotated[str, Field(max_length=128)] = ""
    template: Annotated[str, Field(max_length=40)] = "machine"


class NewIdBody(HttpBody):
    """The new id of a document or of its copy."""

    id: Id


class VersionBody(HttpBody):
    """One version of a document and when it was first seen; `by` is `editor`, or `file` for a change on disk."""

    hash: str
    saved_at: float
    by: str
    current: bool


class VersionTextBody(VersionBody):
    """A version with its text."""

    text: str


class FieldChangeBody(HttpBody):
    """One field that differs; null where the field is absent."""

    field: str
    before: object
    after: object


class NodeChangeBody(HttpBody):
    """A node added, removed, changed or moved between two versions; the path `document` is the document itself."""

    path: str
    change: str
    before_path: str | None
    fields: tuple[FieldChangeBody, ...]


class DifferenceBody(HttpBody):
    """The differences of two versions; `layout_only` is true if only canvas positions differ."""

    changes: tuple[NodeChangeBody, ...]
    layout_only: bool


class KeyWriterBody(HttpBody):
    """A node that writes a key, or a container that declares it; the path is empty for the document itself."""

    path: str
    origin: str
    name: str


class KeyReaderBody(HttpBody):
    """A node that reads a key: `defined` is always, maybe (`way` is a path without it), never, or unreachable."""

    path: str
    by: str
    name: str
    required: bool
    defined: str
    sources: tuple[str, ...]
    way: str


class KeyFlowBody(HttpBody):
    """One key with all its writers and readers."""

    key: str
    writers: tuple[KeyWriterBody, ...]
    readers: tuple[KeyReaderBody, ...]


class KeyBody(HttpBody):
    """A parameter or userdata key, with its JSON Schema."""

    name: str
    required: bool
    default: object
    json_schema: dict[str, object] = Field(validation_alias="schema", serialization_alias="schema")


class StateBody(HttpBody):
    """A state that a behavior can use."""

    name: str
    group: str
    summary: str
    doc: str
    outcomes: tuple[str, ...]
    success: tuple[str, ...]
    parameters: tuple[KeyBody, ...]
    inputs: tuple[KeyBody, ...]
    outputs: tuple[KeyBody, ...]


class ContainerBody(HttpBody):
    """A kind of container node; `only_in_tree` restricts it to behavior trees."""

    kind: str
    title: str
    doc: str
    only_in_tree: bool


class ReferableBehaviorBody(HttpBody):
    """A behavior that another behavior may refer to."""

    id: str
    name: str
    description: str
    outcomes: tuple[str, ...]
    success: tuple[str, ...]
    parameters: tuple[KeyBody, ...]


class EntryBody(HttpBody):
    """A named entry of the cell's store."""

    kind: str
    name: str
    tags: tuple[str, ...]


class CatalogueBody(HttpBody):
    """Everything that a behavior can use.

    `names` are the names in the open cell by kind, the `cell_name` in the JSON Schema of a parameter: robots, parts,
    cameras, frames. A tool, link, output or label has the prefix of its owner: `left/panda_hand`.
    """

    states: tuple[StateBody, ...]
    containers: tuple[ContainerBody, ...]
    behaviors: tuple[ReferableBehaviorBody, ...]
    entries: tuple[EntryBody, ...]
    names: dict[str, tuple[str, ...]]
