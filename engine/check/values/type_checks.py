"""Checks that the values that reach a node have a type that it accepts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt
from engine.check.finding import Finding
from engine.check.flow.definition_sites import DefinitionSite
from engine.check.flow.key_reads import expressions, only_name
from engine.check.flow.type_inference import TypeInference
from engine.check.flow.userdata_flow import BEHAVIOR
from engine.check.flow.value_type import (
    ConstantValue,
    InferredType,
    TypeFit,
    describe_inferred_type,
    describe_misfit,
    describe_type,
    type_fit,
    type_of,
)
from engine.check.flow.witness_path import format_witness_path, witness_path
from engine.errors import ExpressionError

_MOST_ROUTES = 100


@dataclass(frozen=True)
class _Use:
    """A place that expects a value of a type: an input key, or a value with expressions."""

    placed: NodeAt
    keys: tuple[str | int, ...]
    what: str
    due: Any
    key: str | None
    """The userdata key that the value is read from, if any."""
    value: object = None

    @property
    def expects(self) -> str:
        """The expected type as text."""
        return f"{self.what} expects {describe_type(type_of(self.due))}"


def check_types(subject: AnalyzedBehavior, resolver: TypeInference) -> Iterator[Finding]:
    """Find inputs, parameters, guards and lists that get values of a wrong type."""
    check = _Kinds(subject, resolver)
    for placed in subject.due:
        if placed.path in resolver.flow.before:
            yield from check.node(placed)


class _Kinds:
    def __init__(self, subject: AnalyzedBehavior, resolver: TypeInference) -> None:
        self._subject = subject
        self._resolver = resolver
        self._routes = 0
        self._refused: dict[int, dict[str, _Refusal]] = {}

    def node(self, placed: NodeAt) -> Iterator[Finding]:
        for use in _uses(self._subject, placed):
            try:
                reaching = _reaching(self._resolver, use)
            except ExpressionError as error:
                hint = error.hint or "convert it, for example with `string(…)`, `int(…)` or `double(…)`"
                yield self._subject.finding("type-mismatch", error.message, placed.path, *use.keys, hint=hint)
                continue
            yield from self._compared(use, reaching)
        if placed.node.behavior is not None and placed.node.inputs:
            yield from self._inside(placed)

    def _compared(self, use: _Use, reaching: Sequence[tuple[DefinitionSite | None, InferredType]]) -> Iterator[Finding]:
        wrong = [(site, kind) for site, kind in reaching if type_fit(kind, use.due) is TypeFit.NO]
        if not wrong:
            return
        site, kind = wrong[0]
        always = len(wrong) == len(reaching)
        message = f"{use.expects}, but {'gets' if always else 'may get'} {describe_inferred_type(kind)}"
        if site is not None:
            message += self._origin_text(use.placed.path, site, always=always)
        code = "type-mismatch" if always else "maybe-type-mismatch"
        yield self._subject.finding(code, message, use.placed.path, *use.keys, hint=_complaint(kind, use.due))

    def _origin_text(self, path: str, site: DefinitionSite, *, always: bool) -> str:
        """Return the origin of a value and, if other values also arrive, its path."""
        self._routes += 1
        if self._routes > _MOST_ROUTES:
            return f" from {_origin(self._subject, site, site.path)}"
        steps = witness_path(self._resolver.flow, path, 1 << site.number)
        at = steps[0] if self._resolver.flow.sites.shared(site) and len(steps) > 1 else site.path
        origin = f" from {_origin(self._subject, site, at)}"
        return origin if always or len(steps) == 1 else f"{origin} on the path {format_witness_path(steps)}"

    def _inside(self, placed: NodeAt) -> Iterator[Finding]:
        """Find uses inside a referred behavior that do not accept the values passed here."""
        referred = self._subject.referred(placed.node)
        inner = self._resolver.inner(placed.path)
        if referred is None or inner is None:
            return
        if id(inner) not in self._refused:
            self._refused[id(inner)] = {refusal.key: refusal for refusal in _refusals(referred, inner)}
        for name, refusal in self._refused[id(inner)].items():
            if name in placed.node.inputs:
                where = f"{refusal.expects}, at `{refusal.path}` of `{placed.node.behavior}`"
                message = f"{where}, but {'gets' if refusal.always else 'may get'} {refusal.gets} through `{name}`"
                code = "type-mismatch" if refusal.always else "maybe-type-mismatch"
                yield self._subject.finding(code, message, placed.path, "in", name)


@dataclass(frozen=True)
class _Refusal:
    """A node inside a referred behavior that does not accept an initial value passed to the behavior."""

    key: str
    path: str
    expects: str
    gets: str
    always: bool


def _refusals(referred: AnalyzedBehavior, inner: TypeInference) -> Iterator[_Refusal]:
    for other in referred.nodes.values():
        for use in _uses(referred, other) if other.path in inner.flow.before else ():
            try:
                reaching = _reaching(inner, use)
            except ExpressionError:
                continue  # reported by the check of the behavior itself, if it always occurs
            wrong = [(site, kind) for site, kind in reaching if type_fit(kind, use.due) is TypeFit.NO]
            for site, kind in wrong:
                if site is not None and site.path == BEHAVIOR:
                    always = len(wrong) == len(reaching)
                    yield _Refusal(site.key, other.path, use.expects, describe_inferred_type(kind), always)


def _uses(subject: AnalyzedBehavior, placed: NodeAt) -> Iterator[_Use]:
    node = placed.node
    signature = subject.signature(node)
    referred = subject.referred(node)
    if signature is not None:
        for name, key in signature.inputs.items():
            keys = ("in", name) if name in node.inputs else ()
            what = f"the input `{name}` of `{node.state}`"
            yield _Use(placed, keys, what, key.type, node.inputs.get(name, name))
    for keys, found in expressions(placed):
        due: Any = None
        what = f"`{keys[-1]}`"
        if keys[0] == "guard":
            due, what = bool, "the guard"
        elif keys[0] == "foreach":
            due = list[object] if keys[1] == "items" else float
        elif signature is not None and keys[1] in signature.parameters:
            due, what = signature.parameters[str(keys[1])].type, f"the parameter `{keys[1]}` of `{node.state}`"
        elif referred is not None and keys[1] in referred.behavior.parameters:
            parameter = referred.behavior.parameters[str(keys[1])]
            due, what = parameter.value_type, f"the parameter `{keys[1]}` of `{node.behavior}`"
        if due is not None:
            yield _Use(placed, keys, what, due, only_name(found), found.value)


def _reaching(resolver: TypeInference, use: _Use) -> Sequence[tuple[DefinitionSite | None, InferredType]]:
    if use.key is not None:
        return resolver.before(use.placed.path, use.key)
    return [(None, kind) for kind in resolver.of_value(use.value, use.placed.path)]


def _complaint(kind: InferredType, due: Any) -> str:
    return describe_misfit(kind.value, due) if isinstance(kind, ConstantValue) else ""


def _origin(subject: AnalyzedBehavior, site: DefinitionSite, path: str) -> str:
    match site.origin:
        case "parameter":
            return f"the parameter `{site.key}`"
        case "userdata":
            return f"the initial value of `{site.key}`"
        case "item" | "index":
            return f"`{site.key}` of the rounds of `{site.path}`"
        case "collect":
            return f"the values collected by `{site.path}`"
        case _:
            return f"`{site.name}` of `{subject.run_path(path)}`"
