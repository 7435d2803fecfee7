"""A document as the canvas draws it, complete or not: the graph of a run, and all fields that a form shows."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import accumulate
from typing import cast

import msgspec

from engine.document.canvas_note import CanvasNote
from engine.document.nodes.concurrency_condition import ConcurrencyCondition
from engine.document.nodes.node_kind import MACHINES, SLOTS
from engine.document.nodes.node_kinds import node_icon
from engine.editing.project_context import NodeOutcomes, ProjectContext, rules, texts
from engine.editing.text.draft import Draft
from engine.editing.text.outline import NodeRef, Outline, Plain
from engine.editing.text.syntax import Collection
from engine.library.behavior_graph import GraphNode, GraphTransition

_SHOWN_APART = frozenset(("states", "initial", "conditions", "otherwise", "userdata", "children", "child"))


class DocumentNode(GraphNode, frozen=True, kw_only=True, gc=False):
    """One node as written: values raw, `${…}` not evaluated; lines and columns count from 1.

    `targets` are its own transitions, outcome to target; `transitions` are, as in the graph of a run, the
    arrows between its children. `settings` are the remaining keys of its kind, such as `memory` or `times`.
    `document` is the id of the behavior that it references. `exits` are the outcomes that its container does not lead
    anywhere yet. `role` is its key in the surrounding tree node, such as `then`. `canvas_notes` stand freely inside it.
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
    canvas_notes: dict[str, CanvasNote]
    position: tuple[float, float] | None
    rules: tuple[ConcurrencyCondition, ...]
    otherwise: str | None
    userdata: dict[str, object]
    settings: dict[str, object]
    children: tuple[DocumentNode, ...]  # pyright: ignore[reportIncompatibleVariableOverride]


Lines = tuple[int, int, int]
"""Line, column and last line of a node."""


class DrawnNode(msgspec.Struct, frozen=True, gc=False):
    """A node by itself: `node` has no children, transitions and lines; `own` is its JSON.

    `children` are the names of its children, `arrows` its own transitions, which belong to its container.
    """

    node: DocumentNode
    own: bytes
    lines: Lines
    children: tuple[str, ...]
    arrows: tuple[GraphTransition, ...]


class _KnownNode(msgspec.Struct, frozen=True):
    """A node as drawn, with what it depends on beside its own text; `ends` are the outcomes of a container."""

    source: Collection
    around: tuple[object, ...]
    drawn: DrawnNode
    ends: NodeOutcomes | None


@dataclass(frozen=True)
class DrawnGraph:
    """The graph of a document: its nodes by path, containers before their children."""

    nodes: dict[str, DrawnNode]
    known: dict[int, _KnownNode] = field(repr=False)
    """The nodes without a reference inside, by the id of their text, for the next graph."""

    def whole(self) -> DocumentNode | None:
        """Return the root with everything inside it; None if the document has no nodes."""
        made: dict[str, DocumentNode] = {}
        for path, drawn in reversed(self.nodes.items()):
            line, column, end_line = drawn.lines
            made[path] = msgspec.structs.replace(
                drawn.node,
                line=line,
                column=column,
                end_line=end_line,
                children=tuple(made[f"{path}/{name}"] for name in drawn.children),
                transitions=tuple(arrow for name in drawn.children for arrow in self.nodes[f"{path}/{name}"].arrows),
            )
        return made.get("root")


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


def draw_graph(draft: Draft, context: ProjectContext, outline: Outline, before: DrawnGraph | None = None) -> DrawnGraph:
    """Build the graph of a document.

    Args:
        draft: The document.
        context: The states and behaviors around it.
        outline: Its nodes.
        before: The graph of the text from which the draft was made: nodes whose text is the same are not drawn
            again, unless it refers to another document, which may be another one now.
    """
    drawing = _Drawing(draft, context, outline, before.known if before is not None else {})
    return DrawnGraph({path: drawing.node(ref) for path, ref in outline.refs.items()}, drawing.known)


class _Drawing:
    def __init__(
        self, draft: Draft, context: ProjectContext, outline: Outline, before: Mapping[int, _KnownNode]
    ) -> None:
        self.known: dict[int, _KnownNode] = {}
        self._before = before
        self._draft = draft
        self._context = context
        self._outline = outline
        self._view = _mapping(draft.data.get("view"))
        self._notes = _mapping(draft.data.get("notes"))
        self._canvas_notes = _mapping(draft.data.get("canvas_notes"))
        text = draft.origin.text
        self._starts = list(accumulate((len(line) + 1 for line in text.split("\n")), initial=0))[:-1]
        self._ends: dict[str, NodeOutcomes] = {}
        self._closed: dict[str, bool] = {}
        self._places: dict[int, int] = {}
        self._place(draft.data)
        for path, ref in outline.refs.items() if before else ():
            known = self._known_before(ref) if ref.kind != "state" else None
            if known is not None and known.ends is not None:
                self._ends[path] = known.ends

    def _place(self, *inside: object) -> None:
        """Remember where the keys of all entries of these collections are."""
        for each in inside:
            source = self._draft.source_of(each)
            if source is not None:
                self._places.update([(id(member.value), member.at) for member in source.members])

    def node(self, ref: NodeRef) -> DrawnNode:
        """Draw a node, after its container."""
        path, data, parent = ref.path, ref.data, ref.parent
        source = self._draft.source_of(data)
        lines = self._lines(source)
        is_state = isinstance(data.get("state"), str)
        if not is_state:
            self._place(data, data.get(ref.kind), ref.body.get("states"), ref.body.get("children"))
        if source is None or parent is None or not (is_state or self._is_closed(ref)):
            return self._drawn(ref, lines)
        # What it shows follows from its text and from these.
        note, place, free = self._notes.get(path), self._view.get(path), self._canvas_notes.get(path)
        around = (
            path, ref.role, parent.kind in MACHINES, _text(note) if note is not None else "",
            self._draft.source_of(place) if place is not None else None,
            self._draft.source_of(free) if free is not None else None,
        )  # fmt: skip
        known = self._before.get(id(source))
        if known is None or known.source is not source or known.around != around:
            drawn = self._drawn(ref, lines)
            known = _KnownNode(source, around, drawn, self._ends[path] if not is_state else None)
        elif known.drawn.lines != lines:
            was = known.drawn
            drawn = DrawnNode(was.node, was.own, lines, was.children, was.arrows)
            known = _KnownNode(source, around, drawn, known.ends)
        self.known[id(source)] = known
        return known.drawn

    def _known_before(self, ref: NodeRef) -> _KnownNode | None:
        """Return a node as it was drawn before, if its text is the same."""
        source = self._draft.source_of(ref.data)
        known = self._before.get(id(source)) if source is not None else None
        return known if known is not None and known.source is source else None

    def _is_closed(self, ref: NodeRef) -> bool:
        """Return whether neither a node nor one inside it refers to another document."""
        found = self._closed.get(ref.path)
        if found is None:
            found = self._known_before(ref) is not None or (
                not isinstance(ref.data.get("behavior"), str) and all(map(self._is_closed, self._outline.children(ref)))
            )
            self._closed[ref.path] = found
        return found

    def _drawn(self, ref: NodeRef, lines: Lines) -> DrawnNode:
        node = self._new(ref)
        children = tuple(child.name for child in self._outline.children(ref))
        return DrawnNode(node, msgspec.json.encode(node), lines, children, _arrows(ref))

    def _new(self, ref: NodeRef) -> DocumentNode:
        """Draw a node by itself."""
        data, body = ref.data, ref.body
        ends = self._context.ends(self._outline, ref, known=self._ends)
        targets = _names(data.get("transitions"))
        wired = ref.parent is not None and ref.parent.kind in MACHINES
        reference = data.get("behavior")
        return DocumentNode(
            path=ref.path,
            name=ref.name,
            label=_text(self._draft.data.get("name")) or "root" if ref.parent is None else ref.name,
            role=ref.role,
            kind=ref.kind,
            icon=node_icon(ref.kind, self._context.catalogue.get(_text(data.get("state")))),
            title=_text(data.get("state") or reference or data.get("behaviour")),
            description=_text(data.get("description")),
            outcomes=self._outcomes(ref, ends.outcomes),
            children=(),
            transitions=(),
            initial=_optional(body.get("initial")),
            conditions=_in_words(ref),
            line=0,
            column=0,
            end_line=0,
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
            disabled=_disabled(data),
            post=_measure(data.get("post"), decorates=False),
            on_error=_optional(data.get("on_error")),
            resume=_optional(data.get("resume")),
            success=texts(data.get("success")),
            every=data.get("every"),
            notes=_text(self._notes.get(ref.path)),
            canvas_notes=_canvas_notes(self._canvas_notes.get(ref.path)),
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

    def _document(self, reference: object) -> str | None:
        file = self._context.file_of(reference) if isinstance(reference, str) else None
        return file.relative_to(self._context.project.resolve()).as_posix() if file is not None else None

    def _lines(self, source: Collection | None) -> Lines:
        if source is None:
            return 1, 1, 1
        starts = self._starts
        at = self._places.get(id(source), source.start)
        # Lines count from 1: that of an offset is the number of lines that begin before it or there.
        line, last = bisect_right(starts, at), source.end - 1
        return line, at - starts[line - 1] + 1, bisect_right(starts, last) if last > at else line


def _disabled(data: Plain) -> bool | str:
    value = data.get("disabled")
    return value if isinstance(value, bool | str) else False


def _arrows(ref: NodeRef) -> tuple[GraphTransition, ...]:
    if ref.parent is None or ref.parent.kind not in MACHINES:
        return ()
    targets = _names(ref.data.get("transitions"))
    guard, timeout = _mapping(ref.data.get("guard")), _mapping(ref.data.get("timeout"))
    targets |= {f"unless {guard.get('when')}": str(guard["to"])} if guard.get("to") else {}
    targets |= {f"after {timeout.get('after')}": str(timeout["to"])} if timeout.get("to") else {}
    targets |= {"error": str(ref.data["on_error"])} if ref.data.get("on_error") else {}
    return tuple(
        GraphTransition(source=ref.name, outcome=outcome, target=target) for outcome, target in targets.items()
    )


def _rules(ref: NodeRef) -> list[ConcurrencyCondition]:
    return rules(ref) if ref.kind == "concurrency" else []


def _in_words(ref: NodeRef) -> tuple[str, ...]:
    texts = [f"{rule.consequence}: {rule}" for rule in _rules(ref)]
    otherwise = ref.body.get("otherwise") if ref.kind == "concurrency" else None
    return (*texts, *([f"{otherwise}: otherwise"] if otherwise else []))


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


def _canvas_notes(value: object) -> dict[str, CanvasNote]:
    """Return the notes that can be read; those with mistakes are findings."""
    found: dict[str, CanvasNote] = {}
    for name, each in _mapping(value).items():
        try:
            found[name] = msgspec.convert(each, CanvasNote)
        except msgspec.ValidationError:
            continue
    return found


def _point(value: object) -> tuple[float, float] | None:
    if not isinstance(value, list):
        return None
    numbers = [
        each for each in cast("list[object]", value) if isinstance(each, int | float) and not isinstance(each, bool)
    ]
    return (float(numbers[0]), float(numbers[1])) if len(numbers) == 2 else None
