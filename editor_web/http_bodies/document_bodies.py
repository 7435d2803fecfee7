"""The JSON of the editor: documents as texts with what they draw, their versions, and what can be put into them."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from editor_web.http_bodies.common_bodies import ErrorBody, FindingBody, GraphNodeBody, HttpBody
from engine.document.yaml_source import MAX_BYTES

Text = Annotated[str, Field(max_length=MAX_BYTES)]
Hash = Annotated[str, Field(pattern="^[0-9a-f]{64}$")]
Path = Annotated[str, Field(max_length=4000)]
Id = Annotated[str, Field(max_length=300)]
CanvasPosition = tuple[float, float]


class RuleBody(HttpBody):
    """One condition of a concurrency container: the outcome, and which child must have ended how, all or `at_least`.

    One that preempts some children has no outcome.
    """

    outcome: str
    when: dict[str, str]
    at_least: int | None
    preempt: tuple[str, ...]


class DocumentNodeBody(GraphNodeBody):
    """One node as written: beside what a run shows, all that a form edits, raw; lines and columns count from 1.

    `targets` are its own transitions, outcome to target; `exits` the outcomes that lead nowhere yet. `settings` are
    the remaining keys of its kind, such as `memory` or `times`. `document` is the id of the behavior it refers to.
    `role` is the key by which the part around it knows it, such as `then`.
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
    """What the document itself declares, as written."""

    name: str
    description: str
    cell: str | None
    parameters: dict[str, dict[str, object]]
    userdata: dict[str, object]
    outcomes: tuple[str, ...]
    success: tuple[str, ...]


class DraftResultBody(HttpBody):
    """What a text draws, and what is wrong with it; `graph` and `document` are null where it cannot be read.

    `checked` is false where it was not asked for findings, which may follow from `findings`.
    """

    hash: str
    graph: DocumentNodeBody | None
    document: DocumentInfoBody | None
    findings: tuple[FindingBody, ...]
    checked: bool


class DocumentBody(DraftResultBody):
    """A document as it is on disk; `saved_at` is the time of its last change, seconds since 1970."""

    id: str
    text: str
    saved_at: float


class EditRefusalBody(HttpBody):
    """Why no edit was made: `index` says which of them could not be."""

    message: str
    hint: str
    index: int


class EditResultBody(DraftResultBody):
    """The text after the edits, and the nodes that they made or changed; the text as it was where refused."""

    text: str
    changed: tuple[str, ...]
    refused: EditRefusalBody | None


class CopyResultBody(HttpBody):
    """Nodes as YAML, to be pasted anywhere."""

    yaml: str


class TextBody(HttpBody):
    """A text that is being edited."""

    text: Text


class TargetsBody(TextBody):
    """A text whose targets are looked at; a newer one of the same page takes the place of those that still wait."""

    page: Annotated[str, Field(max_length=40)]


class TargetFindingsBody(HttpBody):
    """The targets that an arm of the document's cell cannot be at.

    `dropped` where the page has sent a newer text; `problem` says why they are not known otherwise.
    """

    findings: tuple[FindingBody, ...] = ()
    problem: str = ""
    dropped: bool = False


class DraftBody(TextBody):
    """A text to draw; without `check` the answer comes sooner, and without findings."""

    check: bool = True


class EditsBody(DraftBody):
    """A text and the edits to make in it, all or none; they are those of `engine.editing.edit`."""

    edits: Annotated[list[dict[str, object]], Field(max_length=500)]


class CopyBody(TextBody):
    """A text and the nodes to copy from it."""

    paths: Annotated[list[Path], Field(max_length=1000)]


class SaveBody(TextBody):
    """A text to write, and the hash of the one it was made from."""

    base_hash: Hash


class SaveResultBody(HttpBody):
    """What is on disk now."""

    hash: str
    saved_at: float


class MergeConflictBody(HttpBody):
    """Lines that both sides changed differently; `line` is where they stand in the text that was to be saved."""

    line: int
    base: str
    ours: str
    theirs: str


class ConflictBody(ErrorBody):
    """The document has changed on disk; `merged` has both changes, and is null where they contradict each other."""

    theirs: str
    theirs_hash: str
    merged: str | None
    conflicts: tuple[MergeConflictBody, ...]


class NewDocumentBody(HttpBody):
    """A document to make from a template: machine, sequence or concurrency."""

    id: Id
    name: Annotated[str, Field(max_length=128)] = ""
    template: Annotated[str, Field(max_length=40)] = "machine"


class NewIdBody(HttpBody):
    """Where a document is put, or its copy."""

    id: Id


class VersionBody(HttpBody):
    """One version of a document: when it was first seen; `by` is `editor`, or `file` where it was found there."""

    hash: str
    saved_at: float
    by: str
    current: bool


class VersionTextBody(VersionBody):
    """A version with its text."""

    text: str


class FieldChangeBody(HttpBody):
    """One thing that differs; null where it was not, or is no longer, there."""

    field: str
    before: object
    after: object


class NodeChangeBody(HttpBody):
    """A node that was added, removed, changed or moved between two versions; the path `document` is the document."""

    path: str
    change: str
    before_path: str | None
    fields: tuple[FieldChangeBody, ...]


class DifferenceBody(HttpBody):
    """What differs between two versions; `layout_only` when nothing but positions on the canvas does."""

    changes: tuple[NodeChangeBody, ...]
    layout_only: bool


class KeyWriterBody(HttpBody):
    """A node that writes a key, or a container that declares it; the path is empty for the document itself."""

    path: str
    origin: str
    name: str


class KeyReaderBody(HttpBody):
    """A node that reads a key: `defined` is always, maybe (`way` says how it is not), never, or unreachable."""

    path: str
    by: str
    name: str
    required: bool
    defined: str
    sources: tuple[str, ...]
    way: str


class KeyFlowBody(HttpBody):
    """One key with all that write and read it."""

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
    """A state that can be put into a behavior."""

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
    """A kind of node that holds others; `only_in_tree` says where it may stand."""

    kind: str
    title: str
    doc: str
    only_in_tree: bool


class ReferableBehaviorBody(HttpBody):
    """A behavior that another may refer to."""

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
    """Everything that can be put into a behavior.

    `names` are those of the open cell by kind, which the JSON Schema of a parameter calls `cell_name`: robots, parts,
    cameras, frames. Those of a tool, link, output or label begin with the name of what has it: `left/panda_hand`.
    """

    states: tuple[StateBody, ...]
    containers: tuple[ContainerBody, ...]
    behaviors: tuple[ReferableBehaviorBody, ...]
    entries: tuple[EntryBody, ...]
    names: dict[str, tuple[str, ...]]
