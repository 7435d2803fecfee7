"""Checks that nodes which run side by side do not command the same device."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any, cast

import msgspec

from engine.check.finding import Finding
from engine.check.subject import Placed, Subject
from engine.document.expression import Template
from engine.document.signature import StateSignature
from engine.errors import ExpressionError
from engine.state import State

_UNKNOWN = "\0unknown"
"""Stands for values that only a run knows; a resource named with it is not compared."""
_SIDE_BY_SIDE = ("concurrency", "parallel")
_MOST_USES = 20_000
"""Uses of referred behaviors that are looked at, each with the parameters it gives."""


def check_resources(subject: Subject) -> Iterator[Finding]:
    """Find resources that two branches of a concurrency or parallel use, as far as constants tell."""
    if not any(placed.kind in _SIDE_BY_SIDE for placed in subject.nodes.values()):
        return
    used = _Resources().used(subject, dict.fromkeys(subject.behavior.parameters, _UNKNOWN))
    for placed in subject.nodes.values():
        if placed.kind not in _SIDE_BY_SIDE:
            continue
        owners: dict[str, Placed] = {}
        for child in subject.children(placed):
            for resource in sorted(used[child.path]):
                other = owners.setdefault(resource, child)
                if other is not child:
                    message = f"`{other.name}` and `{child.name}` run side by side and both command `{resource}`"
                    yield subject.finding("shared-resource", message, child.path, hint="run them one after the other")


class _Resources:
    """The resources of nodes; what a referred behavior uses is worked out once for the same parameters."""

    def __init__(self) -> None:
        self._uses = 0
        self._of_references: dict[tuple[int, str], frozenset[str]] = {}

    def used(self, subject: Subject, known: Mapping[str, object]) -> dict[str, frozenset[str]]:
        """Return the resources of every node and everything inside it, by path.

        Args:
            subject: The behavior.
            known: Its parameters; those that only a run knows are `_UNKNOWN`.
        """
        used: dict[str, frozenset[str]] = {}
        for placed in subject.inside_out:
            inside = (used[child.path] for child in subject.children(placed))
            used[placed.path] = self._own(subject, placed, known).union(*inside)
        return used

    def _own(self, subject: Subject, placed: Placed, known: Mapping[str, object]) -> frozenset[str]:
        signature = subject.signature(placed.node)
        if signature is not None:
            # Most states command nothing, and a class that does not say otherwise need not be made.
            if not signature.commands_hardware:
                return frozenset()
            return _state_resources(signature, _given(subject, placed, known))
        referred = subject.referred(placed.node)
        if referred is None or self._uses > _MOST_USES:
            return frozenset()
        inner = {**dict.fromkeys(referred.behavior.parameters, _UNKNOWN), **_given(subject, placed, known)}
        key = (id(referred), repr(sorted(inner.items())))
        if key not in self._of_references:
            self._uses += 1
            self._of_references[key] = self.used(referred, inner)["root"]
        return self._of_references[key]


def _given(subject: Subject, placed: Placed, known: Mapping[str, object]) -> dict[str, object]:
    """Return the parameters that a node is given; those that depend on unknown values are unknown."""
    values: dict[str, object] = {}
    for name, found in subject.given_to(placed).items():
        values[name] = _UNKNOWN
        if isinstance(found, Template) and all(known.get(used, _UNKNOWN) != _UNKNOWN for used in found.names):
            try:
                values[name] = found.evaluate(known)
            except ExpressionError:
                continue  # told where kinds are compared
    return values


def _state_resources(signature: StateSignature, given: Mapping[str, object]) -> frozenset[str]:
    """Ask the state, made with stand-ins for the values that are unknown, which resources it commands."""
    values: dict[str, object] = {}
    for name, parameter in signature.parameters.items():
        value = given.get(name, _UNKNOWN if parameter.required else parameter.default)
        try:
            known = name in given and value != _UNKNOWN
            values[name] = msgspec.convert(value, cast("type[Any]", parameter.type)) if known else value
        except msgspec.ValidationError:
            return frozenset()  # told as a parameter that does not fit
    names = _field_names(signature.state)
    try:
        state = signature.state(**{names[name]: value for name, value in values.items()})
        return frozenset(name for name in state.resources() if _UNKNOWN not in name)
    except Exception:
        # It is a custom class, asked with stand-ins for unknown values: what it names is then unknown too.
        return frozenset()


@cache
def _field_names(state: type[State]) -> Mapping[str, str]:
    """Field name by parameter name; kept, as reading type hints for every node would double the load time."""
    return {found.encode_name: found.name for found in msgspec.structs.fields(state)}
