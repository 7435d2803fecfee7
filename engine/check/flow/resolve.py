"""Of which kind the values are that reach a reader, as far as the document and the state classes say."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import cast

from engine.check.flow.flow import BEHAVIOR, Flow
from engine.check.flow.kind import (
    ANYTHING,
    INTEGER,
    LIST,
    TEXT,
    Constant,
    Kind,
    Listed,
    Mapped,
    describe,
    in_expression,
    item_kinds,
    of_annotation,
    of_expression,
)
from engine.check.flow.site import Site
from engine.check.subject import Subject, template
from engine.document.expression import Expression, Template, split_text
from engine.document.parameter import Parameter
from engine.errors import ExpressionError

Kinds = tuple[Kind, ...]
_ROUNDS = 8
_MOST = 16


class Flows:
    """The flow of each behavior of a check, worked out when first asked for."""

    def __init__(self, make: Mapping[int, Flow]) -> None:
        self._flows = make

    def of(self, subject: Subject) -> Flow:
        """Return the facts about the keys of a behavior."""
        return self._flows[id(subject)]


class Resolver:
    """The kinds of the keys of one behavior, when its own keys are as the document says or as `given`.

    Args:
        flow: The facts about its keys.
        flows: Those of the behaviors it refers to.
        given: Kinds of the initial values that a reference passes in.
    """

    def __init__(self, flow: Flow, flows: Flows, given: Mapping[str, Kinds] | None = None) -> None:
        self.flow = flow
        self._flows = flows
        self._given = dict(given or {})
        self._known: dict[Site, Kinds] = {}
        self._inner: dict[str, Resolver] = {}
        self._settle()

    def of_site(self, site: Site) -> Kinds:
        """Return what a place may write."""
        return self._known.get(site, ())

    def before(self, path: str, key: str) -> tuple[tuple[Site, Kind], ...]:
        """Return what a key may be when the node at `path` is entered, and where it comes from."""
        return self._reaching(key, self.flow.before.get(path, 0))

    def at_the_end(self, key: str) -> Kinds:
        """Return what a key may be when the behavior has ended."""
        return _united(kind for _, kind in self._reaching(key, self.flow.end()))

    def of_value(self, value: object, path: str) -> Kinds:
        """Return what a value of a document may become at the node at `path`; none while nothing is known.

        Raises:
            ExpressionError: an expression in it fails with the values that reach it.
        """
        if isinstance(value, str):
            return self._of_text(value, path)
        if not _live(value):
            return (Constant(value),)
        if isinstance(value, dict):
            fields = cast("dict[str, object]", value)
            return (Mapped({key: _one(self.of_value(item, path)) for key, item in fields.items()}),)
        items = cast("list[object]", value)
        return (Listed(tuple(_one(self.of_value(item, path)) for item in items)),)

    def inner(self, path: str) -> Resolver | None:
        """Return the kinds inside the behavior that the node at `path` refers to, in the use made of it there."""
        placed = self.flow.subject.nodes[path]
        referred = self.flow.subject.referred(placed.node)
        if referred is None:
            return None
        given = {
            name: _united(kind for _, kind in self.before(path, source)) for name, source in placed.node.inputs.items()
        }
        known = self._inner.get(path)
        if known is None or known._given != given:
            known = self._inner[path] = Resolver(self._flows.of(referred), self._flows, given)
        return known

    def _reaching(self, key: str, fact: int) -> tuple[tuple[Site, Kind], ...]:
        if key not in self.flow.sites:
            return ()
        return tuple((site, kind) for site in self.flow.sites.places(key, fact) for kind in self.of_site(site))

    def _settle(self) -> None:
        """Work out all places; those that pass on what reaches them are asked until nothing changes."""
        passing: list[Site] = []
        for site in self.flow.sites:
            kinds = self._declared(site)
            if kinds is None:
                passing.append(site)
            else:
                self._known[site] = kinds
        for _ in range(_ROUNDS):
            changed = [site for site in passing if self._passed_anew(site)]
            if not changed:
                return
        for site in passing:
            self._known[site] = (ANYTHING,)

    def _passed_anew(self, site: Site) -> bool:
        before = self._known.get(site, ())
        self._known[site] = _united((*before, *self._passed(site)))
        return self._known[site] != before

    def _declared(self, site: Site) -> Kinds | None:
        """Return the kinds of a place that does not depend on what reaches it, None for others."""
        behavior = self.flow.subject.behavior
        if site.origin == "parameter":
            return parameter_kinds(behavior.parameters[site.key])
        if site.origin == "userdata":
            return self._initial(site)
        if site.origin == "index":
            return (INTEGER,)
        if site.origin == "collect":
            return (LIST,)
        if site.origin == "output" and self._passes(site) is None:
            signature = self.flow.subject.signature(self.flow.subject.nodes[site.path].node)
            return (of_annotation(signature.outputs[site.name].type) if signature is not None else ANYTHING,)
        return None

    def _initial(self, site: Site) -> Kinds:
        if site.path != BEHAVIOR:
            return (Constant(self.flow.subject.nodes[site.path].node.userdata[site.key]),)
        if site.key in self._given:
            return self._given[site.key]
        value = self.flow.subject.behavior.document.userdata[site.key]
        # Nothing as the initial value of a behavior means that each run, or reference, is to give one.
        return (Constant(value) if value is not None else ANYTHING,)

    def _passes(self, site: Site) -> str | None:
        """Return the parameter whose value an output repeats, None where there is none."""
        signature = self.flow.subject.signature(self.flow.subject.nodes[site.path].node)
        declared = signature.parameters.values() if signature is not None else ()
        return next((key.name for key in declared if key.schema.get("output") == site.name), None)

    def _passed(self, site: Site) -> Kinds:
        placed = self.flow.subject.nodes[site.path]
        if site.origin == "item":
            rounds = placed.node.foreach
            if rounds is None or rounds.items is None:
                return (INTEGER,)
            return _united(item for kind in self._tried(rounds.items, site.path) for item in item_kinds(kind))
        if site.origin == "reference":
            inner = self.inner(site.path)
            return inner.at_the_end(site.name) if inner is not None else (ANYTHING,)
        name = self._passes(site) or ""
        if name in placed.node.parameters:
            return self._tried(placed.node.parameters[name], site.path)
        signature = self.flow.subject.signature(placed.node)
        return (Constant(signature.parameters[name].default) if signature is not None else ANYTHING,)

    def _tried(self, value: object, path: str) -> Kinds:
        try:
            return self.of_value(value, path)
        except ExpressionError:
            return (ANYTHING,)  # said where the value stands

    def _of_text(self, text: str, path: str) -> Kinds:
        if "${" not in text:
            return (Constant(text),)
        pieces = split_text(text)
        if len(pieces) != 1:
            for piece in pieces:
                if isinstance(piece, Expression):
                    self._of_expression(piece, path)
            return (TEXT,)
        only = pieces[0]
        return self._of_expression(only, path) if isinstance(only, Expression) else (Constant(only),)

    def _of_expression(self, expression: Expression, path: str) -> Kinds:
        variables = {name: _united(kind for _, kind in self.before(path, name)) for name in expression.names}
        if expression.bare:
            return variables[expression.text]
        if not all(variables.values()):
            return ()
        return (of_expression(expression.result_type({name: in_expression(v) for name, v in variables.items()})),)


def parameter_kinds(parameter: Parameter) -> Kinds:
    """Return what a parameter of a behavior may be."""
    if parameter.choices:
        return tuple(Constant(parameter.normal(choice)) for choice in parameter.choices)
    return (of_annotation(parameter.value_type),)


def _united(kinds: Iterable[Kind]) -> Kinds:
    found: list[Kind] = []
    for kind in kinds:
        # Names are compared too, for Python takes true for 1.
        if not any(kind == other and describe(kind) == describe(other) for other in found):
            found.append(kind)
        if len(found) > _MOST:
            return (ANYTHING,)
    return tuple(found)


def _one(kinds: Kinds) -> Kind:
    return kinds[0] if len(kinds) == 1 else ANYTHING


def _live(value: object) -> bool:
    found = template(value)
    return not isinstance(found, Template) or not found.constant
