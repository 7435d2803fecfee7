"""Catalogue of the editor: states with their parameters, containers, and other behaviors."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import msgspec

from engine.document.node_spec import KINDS, TREE_KINDS, WRAPPERS
from engine.document.signature import KeySignature, StateSignature, read_signature
from engine.document.state_catalogue import Catalogue
from engine.errors import StateError
from engine.library.behavior_library import Library


@dataclass(frozen=True, kw_only=True)
class KeyView:
    """A parameter or userdata key, with its JSON Schema and its default as plain data."""

    name: str
    required: bool
    default: object
    schema: dict[str, object]


@dataclass(frozen=True, kw_only=True)
class StateView:
    """A state; `group` is the part of its name before the last dot."""

    name: str
    group: str
    summary: str
    doc: str
    outcomes: tuple[str, ...]
    success: tuple[str, ...]
    parameters: tuple[KeyView, ...]
    inputs: tuple[KeyView, ...]
    outputs: tuple[KeyView, ...]


@dataclass(frozen=True, kw_only=True)
class ContainerView:
    """A kind of node that holds others."""

    kind: str
    title: str
    doc: str
    only_in_tree: bool


@dataclass(frozen=True, kw_only=True)
class BehaviorReferenceView:
    """A behavior that another behavior may reference by its file."""

    id: str
    name: str
    description: str
    outcomes: tuple[str, ...] = ()
    success: tuple[str, ...] = ()
    parameters: tuple[KeyView, ...] = field(default=())


_DOCS = {
    "machine": ("State machine", "Executes one child at a time, from the initial one along the transitions."),
    "concurrency": (
        "Concurrency",
        "Executes children concurrently; the first condition that is true decides the outcome.",
    ),
    "priority": ("Priority machine", "A state machine; while it is active, everything outside its path is paused."),
    "tree": ("Behavior tree", "Ticks sequences, selectors and decorators; ends with success or failure."),
    "foreach": ("For each", "Executes its child once for each item, or a number of times."),
    "sequence": ("Sequence", "Executes children in order until one fails."),
    "selector": ("Selector", "Executes children in order until one succeeds."),
    "parallel": ("Parallel", "Executes children in parallel; the policy defines which successes are required."),
    "inverter": ("Inverter", "Inverts success and failure of its child."),
    "one_shot": ("One shot", "Executes its child once and keeps its final status."),
    "repeat": ("Repeat", "Executes its child until it has succeeded a number of times in a row."),
    "cooldown": ("Cooldown", "Fails without ticking its child until a time has passed since the child ended."),
    "remap": ("Remap", "Maps the status of its child to another status."),
    "condition": ("Condition", "Succeeds when its child has a given status, and is running until then."),
    "if_then_else": ("If, then, else", "Executes one child, then the second if it succeeded, else the third."),
    "while_do_else": (
        "While, do, else",
        "Executes the second child while the first succeeds, the third while it fails.",
    ),
    "retry": ("Retry", "Executes its child again after a failure."),
    "timeout": ("Timeout", "Fails when its child takes too long."),
    "guard": ("Guard", "Executes its child only while an expression is true; otherwise fails or is skipped."),
}


def state_views(catalogue: Catalogue) -> tuple[StateView, ...]:
    """Return every state with a valid signature, sorted by name; the check reports broken classes."""
    found: list[StateView] = []
    for name in sorted(catalogue):
        try:
            signature = read_signature(catalogue[name])
        except StateError:
            continue
        if name == signature.name or signature.name not in catalogue:
            found.append(_state(replace(signature, name=name)))
    return tuple(found)


def container_views() -> tuple[ContainerView, ...]:
    """Return every kind of container, those for machines first."""
    kinds = (*KINDS, *TREE_KINDS, *WRAPPERS)
    return tuple(
        ContainerView(kind=kind, title=_DOCS[kind][0], doc=_DOCS[kind][1], only_in_tree=kind not in KINDS)
        for kind in kinds
        if kind in _DOCS
    )


def behavior_reference_views(library: Library) -> tuple[BehaviorReferenceView, ...]:
    """Return the behaviors of a project, sorted by id; an unreadable one has only its known fields."""
    return tuple(
        BehaviorReferenceView(
            id=view.id,
            name=view.name,
            description=view.description,
            outcomes=view.graph.outcomes if view.graph is not None else (),
            success=view.success,
            parameters=tuple(
                KeyView(name=each.name, required=each.required, default=each.schema.get("default"), schema=each.schema)
                for each in view.parameters
            ),
        )
        for view in library.views()
    )


def _state(signature: StateSignature) -> StateView:
    return StateView(
        name=signature.name,
        group=signature.name.rpartition(".")[0],
        summary=signature.summary,
        doc=signature.doc,
        outcomes=signature.outcomes,
        success=signature.success,
        parameters=tuple(map(_key, signature.parameters.values())),
        inputs=tuple(map(_key, signature.inputs.values())),
        outputs=tuple(map(_key, signature.outputs.values())),
    )


def _key(key: KeySignature) -> KeyView:
    default = msgspec.to_builtins(key.default, enc_hook=str) if not key.required else None
    return KeyView(name=key.name, required=key.required, default=default, schema=dict(key.schema))
