"""Checks that nodes which run side by side do not command the same device."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache

import msgspec

from engine.check.finding import Finding
from engine.check.subject import Placed, Subject, new_subject
from engine.document.behavior import Behavior
from engine.document.expression import compile_template
from engine.document.node import Node
from engine.document.signature import StateSignature
from engine.errors import ExpressionError
from engine.state import State

_UNKNOWN = "\0unknown"
"""Stands for values that only a run knows; a resource named with it is not compared."""


def check_resources(subject: Subject) -> Iterator[Finding]:
    """Find resources that two children of a concurrency container use, as far as constants tell."""
    used = _used_resources(subject, _defaults(subject.behavior))
    for placed in subject.nodes.values():
        if placed.node.concurrency is None:
            continue
        owners: dict[str, Placed] = {}
        for child in subject.children(placed):
            for resource in sorted(used[child.path]):
                other = owners.setdefault(resource, child)
                if other is not child:
                    message = f"`{other.name}` and `{child.name}` run side by side and both command `{resource}`"
                    yield subject.finding("shared-resource", message, child.path, hint="run them one after the other")


def _used_resources(subject: Subject, known: Mapping[str, object]) -> dict[str, frozenset[str]]:
    """Return the resources of every node and everything inside it, by path."""
    used: dict[str, frozenset[str]] = {}
    for placed in reversed(list(subject.nodes.values())):
        inside = [used[child.path] for child in subject.children(placed)]
        used[placed.path] = frozenset().union(_own_resources(subject, placed, known), *inside)
    return used


def _own_resources(subject: Subject, placed: Placed, known: Mapping[str, object]) -> frozenset[str]:
    signature = subject.signature(placed.node)
    if signature is not None:
        return _state_resources(signature, _given(placed.node, known))
    referred = subject.behavior.references.get(placed.node.behavior or "")
    if referred is None:
        return frozenset()
    inner = {**_defaults(referred), **_given(placed.node, known)}
    catalogue = {name: found.state for name, found in subject.signatures.items()}
    return _used_resources(new_subject(referred, catalogue), inner)["root"]


def _defaults(behavior: Behavior) -> dict[str, object]:
    """Return what is known of the variables of a behavior: nothing, for its parameters may be given anew."""
    return dict.fromkeys(behavior.parameters, _UNKNOWN)


def _given(node: Node, known: Mapping[str, object]) -> dict[str, object]:
    """Return the parameters that a node is given; those that depend on unknown values are unknown."""
    values: dict[str, object] = {}
    for name, value in node.parameters.items():
        try:
            template = compile_template(value)
            certain = all(known.get(used, _UNKNOWN) != _UNKNOWN for used in template.names)
            values[name] = template.evaluate(known) if certain else _UNKNOWN
        except ExpressionError:
            values[name] = _UNKNOWN
    return values


def _state_resources(signature: StateSignature, given: Mapping[str, object]) -> frozenset[str]:
    state = _instance(signature, given)
    if state is None:
        return frozenset()
    try:
        resources = state.resources()
    except (AttributeError, TypeError, ValueError, LookupError):
        # It was asked with stand-ins for unknown values; what it names is then unknown too.
        return frozenset()
    return frozenset(name for name in resources if _UNKNOWN not in name)


def _instance(signature: StateSignature, given: Mapping[str, object]) -> State | None:
    """Make the state with stand-ins for the values that are unknown."""
    values: dict[str, object] = {}
    for name, parameter in signature.parameters.items():
        value = given.get(name, parameter.default if not parameter.required else _UNKNOWN)
        if value != _UNKNOWN and name in given:
            try:
                value = msgspec.convert(value, parameter.type)
            except msgspec.ValidationError:
                return None
        values[name] = value
    names = _field_names(signature.state)
    return signature.state(**{names[name]: value for name, value in values.items()})


@cache
def _field_names(state: type[State]) -> Mapping[str, str]:
    """Field name by parameter name; kept, as reading type hints for every node would double the load time."""
    return {found.encode_name: found.name for found in msgspec.structs.fields(state)}
