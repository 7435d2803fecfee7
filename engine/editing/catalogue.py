"""Catalogue of the editor: states with their parameters, containers, and other behaviors."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import msgspec

from engine.document.nodes.node_kinds import NODE_KINDS, KindField, node_icon
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
    """A state; `group` is the part of its name before the last dot, `icon` the name of its icon."""

    name: str
    group: str
    icon: str
    summary: str
    doc: str
    outcomes: tuple[str, ...]
    success: tuple[str, ...]
    parameters: tuple[KeyView, ...]
    inputs: tuple[KeyView, ...]
    outputs: tuple[KeyView, ...]


@dataclass(frozen=True, kw_only=True)
class ContainerView:
    """A kind of node that holds others; `icon` is the name of its icon, `form` the fields that its form shows."""

    kind: str
    title: str
    doc: str
    only_in_tree: bool
    icon: str
    form: tuple[KindField, ...]


@dataclass(frozen=True, kw_only=True)
class BehaviorReferenceView:
    """A behavior that another behavior may reference by its file; `icon` is the name of its icon."""

    id: str
    name: str
    icon: str
    description: str
    outcomes: tuple[str, ...] = ()
    success: tuple[str, ...] = ()
    parameters: tuple[KeyView, ...] = field(default=())


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
    return tuple(
        ContainerView(
            kind=each.kind,
            title=each.title,
            doc=each.doc,
            only_in_tree=each.only_in_tree,
            icon=each.icon,
            form=each.form,
        )
        for each in NODE_KINDS.values()
    )


def behavior_reference_views(library: Library) -> tuple[BehaviorReferenceView, ...]:
    """Return the behaviors of a project, sorted by id; an unreadable one has only its known fields."""
    return tuple(
        BehaviorReferenceView(
            id=view.id,
            name=view.name,
            icon=node_icon("behavior"),
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
        icon=node_icon("state", signature.state),
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
