"""What can be put into a behavior: states with their parameters, containers, other behaviors."""

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
    """A behavior that another may refer to by its file."""

    id: str
    name: str
    description: str
    outcomes: tuple[str, ...] = ()
    success: tuple[str, ...] = ()
    parameters: tuple[KeyView, ...] = field(default=())


_DOCS = {
    "machine": ("State machine", "One child at a time, from the initial one along the transitions."),
    "concurrency": ("Concurrency", "Children side by side; the first condition that holds decides the outcome."),
    "priority": ("Priority machine", "A machine; while it is active everything outside its path stands still."),
    "tree": ("Behavior tree", "Sequences, selectors and decorators; ends with success or failure."),
    "foreach": ("For each", "Its child once for each item, or so many times."),
    "sequence": ("Sequence", "Children one after the other until one fails."),
    "selector": ("Selector", "Children one after the other until one succeeds."),
    "parallel": ("Parallel", "Children together; the policy says whose success counts."),
    "inverter": ("Inverter", "Turns success of its child into failure and back."),
    "one_shot": ("One shot", "Runs its child once and remembers how it ended."),
    "repeat": ("Repeat", "Runs its child until it has succeeded so many times in a row."),
    "cooldown": ("Cooldown", "Fails without asking its child until some time has passed since that ended."),
    "remap": ("Remap", "Shows another status than its child has."),
    "condition": ("Condition", "Succeeds when its child has a status, and runs until then."),
    "if_then_else": ("If, then, else", "Asks one child, then runs the second if that succeeded, else the third."),
    "while_do_else": ("While, do, else", "Runs the second child while the first succeeds, the third while it fails."),
    "retry": ("Retry", "Runs its child again after failure."),
    "timeout": ("Timeout", "Fails when its child takes too long."),
    "guard": ("Guard", "Lets its child run only while an expression is true; else fails, or is skipped."),
}


def state_views(catalogue: Catalogue) -> tuple[StateView, ...]:
    """Return every state that can be described, sorted by name; broken classes are left to the check."""
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
    """Return the behaviors of a project, sorted by id; of one that cannot be read only what is known."""
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
