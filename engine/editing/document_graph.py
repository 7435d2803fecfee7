"""A document as the canvas draws it, complete or not: the graph of a run, and all fields that a form shows."""

from __future__ import annotations

from bisect import bisect_right
from itertools import accumulate
from typing import cast

import msgspec

from engine.document.concurrency_condition import ConcurrencyCondition
from engine.document.node_kind import MACHINES, SLOTS
from engine.editing.draft import Draft
from engine.editing.outline import NodeRef, Outline, Plain
from engine.editing.project_context import NodeOutcomes, ProjectContext, rules, texts
from engine.editing.syntax import Collection
from engine.library.behavior_graph import GraphNode, GraphTransition

_SHOWN_APART = frozenset(("states", "initial", "conditions", "otherwise", "userdata", "children", "child"))


class DocumentNode(GraphNode, frozen=True, kw_only=True, gc=False):
    """One node as written: values raw, `${…}` not evaluated; lines and columns count from 1.

    `targets` are its own transitions, outcome to target; `transitions` are, as in the graph of a run, the
    arrows between its children. `settings` are the remaining keys of its kind, such as `memory` or `times`.
    `document` is the id of the behavior that it references. `exits` are the outcomes that its container does not lead
    anywhere yet. `role` is its key in the surrounding tree node, such as `then`.
    """

    label: str
    role: str
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
    position: tuple[float, float] | None
    rules: tuple[ConcurrencyCondition, ...]
    otherwise: str | None
    userdata: dict[str, object]
    settings: dict[str, object]
    children: tuple[DocumentNode, ...]  # pyright: ignore[reportIncompatibleVariableOverride]


class DocumentInfo(msgspec.Struct, frozen=True, kw_only=True):
    """The declarations of the document itself, as written."""

    name: str
    description: str
    cell: str | None
    parameters: dict[str, dict[str, object]]
    userdata: dict[str, object]
    outcomes: tuple[str, ...]
    success: tuple[str, ...]


def info_of(draft: Draft) -> DocumentInfo:
    """Return the declarations of a document; missing or invalid ones are empty."""
    data = draft.data
    cell = data.get("cell")
    return DocumentInfo(
        name=_text(data.get("name")),
        description=_text(data.get("description")),
        cell=cell if isinstance(cell, str) else None,
        parameters={
            name: cast("Plain", each)
            for name, each in _mapping(data.get("parameters")).items()
            if isinstance(each, dict)
        },
        userdata=_mapping(data.get("userdata")),
        outcomes=texts(data.get("outcomes")),
        success=texts(data.get("success")),
    )


def document_graph(draft: Draft, context: ProjectContext) -> DocumentNode | None:
    """Build the graph of a document; None if it has no root."""
    outline = Outline(draft.data)
    root = outline.refs.get("root")
    return _Drawing(draft, context, outline).node(root) if root is not None else None


class _Drawing:
    def __init__(self, draft: Draft, context: ProjectContext, outline: Outline) -> None:
        self._draft = draft
        self._knowledge = context
        self._outline = outline
        self._view = _mapping(draft.data.get("view"))
        self._notes = _mapping(draft.data.get("notes"))
        text = draft.origin.text
        self._starts = list(accumulate((len(line) + 1 for line in text.split("\n")), initial=0))[:-1]
        self._ends: dict[str, NodeOutcomes] = {}
        self._places = {
            id(member.value): member.at
            for found in draft.collections()
            for member in found.members
            if isinstance(member.value, Collection)
        }

    def node(self, ref: NodeRef) -> DocumentNode:
        data, body = ref.data, ref.body
        ends = self._knowledge.ends(self._outline, ref, known=self._ends)
        targets = _names(data.get("transitions"))
        wired = ref.parent is not None and ref.parent.kind in MACHINES
        line, column, end_line = self._lines(data)
        reference = data.get("behavior")
        return DocumentNode(
            path=ref.path,
            name=ref.name,
            label=_text(self._draft.data.get("name")) or "root" if ref.parent is None else ref.name,
            role=ref.role,
            kind=ref.kind,
            title=_text(data.get("state") or reference or data.get("behaviour")),
            description=_text(data.get("description")),
            outcomes=self._outcomes(ref, ends.outcomes),
            children=tuple(self.node(child) for child in self._outline.children(ref)),
            transitions=self._arrows(ref),
            initial=_optional(body.get("initial")),
            conditions=_in_words(ref),
            line=line,
            column=column,
            end_line=end_line,
            state=_optional(data.get("state")),
            reference=_optional(reference),
            document=self._document(reference),
            parameters=_mapping(data.get("with")),
            inputs=_names(data.get("in")),
            outputs=_names(data.get("out")),
            targets=targets,
            exits=tuple(outcome for outcome in ends.outcomes if wired and outcome not in targets),
            autonomy=_names(data.get("autonomy")),
            timeout=_measure(data.get("timeout"), decorates=ref.kind == "timeout"),
            retry=_measure(data.get("retry"), decorates=ref.kind == "retry"),
            guard=_measure(data.get("guard"), decorates=ref.kind == "guard"),
            post=_measure(data.get("post"), decorates=False),
            on_error=_optional(data.get("on_error")),
            resume=_optional(data.get("resume")),
            success=texts(data.get("success")),
            every=data.get("every"),
            notes=_text(self._notes.get(ref.path)),
            position=_point(self._view.get(ref.path)),
            rules=tuple(_rules(ref)),
            otherwise=_optional(body.get("otherwise")) if ref.kind == "concurrency" else None,
            userdata=_mapping(body.get("userdata")),
            settings={key: value for key, value in body.items() if key not in _SHOWN_APART}
            if ref.kind != "tree" and ref.kind not in SLOTS
            else {},
        )

    def _outcomes(self, ref: NodeRef, own: tuple[str, ...]) -> tuple[str, ...]:
        """Return the outcomes of a node; for the root also the declared ones to which nothing leads yet."""
        declared = texts(self._draft.data.get("outcomes")) if ref.parent is None else ()
        return tuple(dict.fromkeys((*declared, *own)))

    def _arrows(self, ref: NodeRef) -> tuple[GraphTransition, ...]:
        if ref.kind not in MACHINES:
            return ()
        found: list[GraphTransition] = []
        for child in self._outline.children(ref):
            ways = _names(child.data.get("transitions"))
            guard, timeout = _mapping(child.data.get("guard")), _mapping(child.data.get("timeout"))
            ways |= {f"unless {guard.get('when')}": str(guard["to"])} if guard.get("to") else {}
            ways |= {f"after {timeout.get('after')}": str(timeout["to"])} if timeout.get("to") else {}
            ways |= {"error": str(child.data["on_error"])} if child.data.get("on_error") else {}
            found += [GraphTransition(source=child.name, outcome=way, target=target) for way, target in ways.items()]
        return tuple(found)

    def _document(self, reference: object) -> str | None:
        file = self._knowledge.file_of(reference) if isinstance(reference, str) else None
        return file.relative_to(self._knowledge.project.resolve()).as_posix() if file is not None else None

    def _lines(self, data: Plain) -> tuple[int, int, int]:
        source = self._draft.source_of(data)
        if not isinstance(source, Collection):
            return 1, 1, 1
        at = self._places.get(id(source), source.start)
        line = self._line(at)
        return line + 1, at - self._starts[line] + 1, self._line(max(at, source.end - 1)) + 1

    def _line(self, offset: int) -> int:
        return bisect_right(self._starts, offset) - 1


def _rules(ref: NodeRef) -> list[ConcurrencyCondition]:
    return rules(ref) if ref.kind == "concurrency" else []


def _in_words(ref: NodeRef) -> tuple[str, ...]:
    said = [f"{rule.consequence}: {rule}" for rule in _rules(ref)]
    otherwise = ref.body.get("otherwise") if ref.kind == "concurrency" else None
    return (*said, *([f"{otherwise}: otherwise"] if otherwise else []))


def _mapping(value: object) -> Plain:
    return cast("Plain", value) if isinstance(value, dict) else {}


def _names(value: object) -> dict[str, str]:
    return {key: each for key, each in _mapping(value).items() if isinstance(each, str)}


def _measure(value: object, *, decorates: bool) -> Plain | None:
    return cast("Plain", value) if isinstance(value, dict) and not decorates else None


def _text(value: object) -> str:
    return value if isinstance(value, str) else ""


def _optional(value: object) -> str | None:
    return value if isinstance(value, str) and value else None


def _point(value: object) -> tuple[float, float] | None:
    if not isinstance(value, list):
        return None
    numbers = [
        each for each in cast("list[object]", value) if isinstance(each, int | float) and not isinstance(each, bool)
    ]
    return (float(numbers[0]), float(numbers[1])) if len(numbers) == 2 else None
