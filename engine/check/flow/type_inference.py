"""Infers the types of the values that reach a reader, from the document and the state classes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import cast

from engine.check.analyzed_behavior import AnalyzedBehavior, template
from engine.check.flow.definition_sites import DefinitionSite
from engine.check.flow.userdata_flow import BEHAVIOR, DataFlow
from engine.check.flow.value_type import (
    ANYTHING,
    INTEGER,
    LIST,
    TEXT,
    ConstantValue,
    InferredType,
    ListValue,
    MappingValue,
    expression_type,
    is_same_type,
    item_types,
    type_of_annotation,
    type_of_expression,
    without_value,
)
from engine.document.expression.cel_expression import Expression
from engine.document.expression.expression import Template, split_text
from engine.document.parameter_spec import ParameterSpec
from engine.errors import ExpressionError

InferredTypes = tuple[InferredType, ...]
_ROUNDS = 8
_MOST = 16
_MOST_USES = 100
"""Maximum number of uses of a behavior with different types that are distinguished."""
_MOST_CONSTANTS = 32
"""Maximum number of values that are distinguished for one key; beyond that only the types are."""


class BehaviorDataFlows:
    """The data flow of each behavior of a check, and the types of its keys for each use."""

    def __init__(self, made: Mapping[int, DataFlow]) -> None:
        self._flows = made
        self._resolvers: dict[int, list[tuple[Mapping[str, InferredTypes], TypeInference]]] = {}

    def of(self, subject: AnalyzedBehavior) -> DataFlow:
        """Return the facts about the keys of a behavior."""
        return self._flows[id(subject)]

    def resolver(self, subject: AnalyzedBehavior, given: Mapping[str, InferredTypes]) -> TypeInference:
        """Return the types of the keys of a behavior with these initial values."""
        known = self._resolvers.setdefault(id(subject), [])
        for others, resolver in known:
            if others == given:
                return resolver
        if len(known) >= _MOST_USES:
            return self.resolver(subject, known[0][0])
        made = TypeInference(self.of(subject), self, given)
        known.append((given, made))
        return made


class TypeInference:
    """The types of the keys of one behavior, with its own keys as in the document or as `given`.

    Args:
        flow: The facts about its keys.
        flows: The data flows of the behaviors it refers to.
        given: Types of the initial values that a reference passes.
    """

    def __init__(
        self, flow: DataFlow, flows: BehaviorDataFlows, given: Mapping[str, InferredTypes] | None = None
    ) -> None:
        self.flow = flow
        self._flows = flows
        self._given = dict(given or {})
        self._written: dict[str, list[tuple[InferredType, int]]] = {}
        """By key, each type that is written to it, with the bits of the sites that write it."""
        self._settle()

    def before(self, path: str, key: str) -> tuple[tuple[DefinitionSite, InferredType], ...]:
        """Return the possible types of a key at the entry of the node at `path`, with their sites."""
        return self._reaching(key, self.flow.before.get(path, 0))

    def at_the_end(self, key: str) -> InferredTypes:
        """Return the possible types of a key at the end of the behavior."""
        return _united(kind for _, kind in self._reaching(key, self.flow.end()))

    def of_value(self, value: object, path: str) -> InferredTypes:
        """Return the possible types of a document value at the node at `path`; none while nothing is known.

        Raises:
            ExpressionError: an expression in it fails with the values that reach it.
        """
        if isinstance(value, str):
            return self._of_text(value, path)
        if not _live(value):
            return (ConstantValue(value),)
        if isinstance(value, dict):
            fields = cast("dict[str, object]", value)
            return (MappingValue({key: _one(self.of_value(item, path)) for key, item in fields.items()}),)
        items = cast("list[object]", value)
        return (ListValue(tuple(_one(self.of_value(item, path)) for item in items)),)

    def inner(self, path: str) -> TypeInference | None:
        """Return the types inside the behavior that the node at `path` refers to, for this reference."""
        placed = self.flow.subject.nodes[path]
        referred = self.flow.subject.referred(placed.node)
        if referred is None:
            return None
        given = {
            name: _united(kind for _, kind in self.before(path, source)) for name, source in placed.node.inputs.items()
        }
        return self._flows.resolver(referred, given)

    def _reaching(self, key: str, fact: int) -> tuple[tuple[DefinitionSite, InferredType], ...]:
        """Return the types that reach the key, each with its first site."""
        found = [(fact & places, kind) for kind, places in self._written.get(key, ()) if fact & places]
        return tuple((self.flow.sites.first(places), kind) for places, kind in found)

    def _settle(self) -> None:
        """Infer the types of all sites; sites that copy values are iterated until nothing changes."""
        passing: list[DefinitionSite] = []
        for site in self.flow.sites:
            kinds = self._declared(site)
            if kinds is None:
                passing.append(site)
            else:
                self._add(site, kinds)
        for _ in range(_ROUNDS):
            changed = [site for site in passing if self._add(site, self._passed(site))]
            if not changed:
                return
        for site in passing:
            self._add(site, (ANYTHING,))

    def _add(self, site: DefinitionSite, kinds: InferredTypes) -> bool:
        """Record the types that a site writes; return whether they are new."""
        written = self._written.setdefault(site.key, [])
        bit = 1 << site.number
        is_new = False
        for found in kinds:
            kind = found if len(written) < _MOST_CONSTANTS else without_value(found)
            index = next(
                (number for number, (known, _) in enumerate(written) if is_same_type(known, kind)), len(written)
            )
            if index == len(written):
                written.append((kind, 0))
            is_new = is_new or not written[index][1] & bit
            written[index] = (kind, written[index][1] | bit)
        return is_new

    def _declared(self, site: DefinitionSite) -> InferredTypes | None:
        """Return the types of a site that does not depend on other sites; None for others."""
        behavior = self.flow.subject.behavior
        if site.origin == "parameter":
            return parameter_types(behavior.parameters[site.key])
        if site.origin == "userdata":
            return self._initial(site)
        if site.origin == "index":
            return (INTEGER,)
        if site.origin == "collect":
            return (LIST,)
        if site.origin == "post":
            return (ANYTHING,)
        if site.origin != "output":
            return None
        signature = self.flow.subject.signature(self.flow.subject.nodes[site.path].node)
        if signature is None:
            return (ANYTHING,)
        passed = signature.passed_on(site.name)
        return (type_of_annotation(signature.outputs[site.name].type),) if passed is None else None

    def _initial(self, site: DefinitionSite) -> InferredTypes:
        if site.path != BEHAVIOR:
            return (ConstantValue(self.flow.subject.nodes[site.path].node.userdata[site.key]),)
        if site.key in self._given:
            return self._given[site.key]
        value = self.flow.subject.behavior.document.userdata[site.key]
        # A null initial value of a behavior means that each run or reference has to set one.
        return (ConstantValue(value) if value is not None else ANYTHING,)

    def _passed(self, site: DefinitionSite) -> InferredTypes:
        placed = self.flow.subject.nodes[site.path]
        if site.origin == "item":
            rounds = placed.node.foreach
            if rounds is None or rounds.items is None:
                return (INTEGER,)
            return _united(item for kind in self._tried(rounds.items, site.path) for item in item_types(kind))
        if site.origin == "reference":
            inner = self.inner(site.path)
            return inner.at_the_end(site.name) if inner is not None else (ANYTHING,)
        signature = self.flow.subject.signature(placed.node)
        name = signature.passed_on(site.name) if signature is not None else None
        if signature is None or name is None:
            return (ANYTHING,)
        given = placed.node.parameters
        return (
            self._tried(given[name], site.path)
            if name in given
            else (ConstantValue(signature.parameters[name].default),)
        )

    def _tried(self, value: object, path: str) -> InferredTypes:
        try:
            return self.of_value(value, path)
        except ExpressionError:
            return (ANYTHING,)  # reported where the value is written

    def _of_text(self, text: str, path: str) -> InferredTypes:
        if "${" not in text:
            return (ConstantValue(text),)
        pieces = split_text(text)
        if len(pieces) != 1:
            for piece in pieces:
                if isinstance(piece, Expression):
                    self._of_expression(piece, path)
            return (TEXT,)
        only = pieces[0]
        return self._of_expression(only, path) if isinstance(only, Expression) else (ConstantValue(only),)

    def _of_expression(self, expression: Expression, path: str) -> InferredTypes:
        variables = {name: _united(kind for _, kind in self.before(path, name)) for name in expression.names}
        if expression.bare:
            return variables[expression.text]
        if not all(variables.values()):
            return ()
        return (
            type_of_expression(expression.result_type({name: expression_type(v) for name, v in variables.items()})),
        )


def parameter_types(parameter: ParameterSpec) -> InferredTypes:
    """Return the possible types of a parameter of a behavior."""
    if parameter.choices:
        return tuple(ConstantValue(parameter.normal(choice)) for choice in parameter.choices)
    return (type_of_annotation(parameter.value_type),)


def _united(kinds: Iterable[InferredType]) -> InferredTypes:
    found: list[InferredType] = []
    for kind in kinds:
        if not any(is_same_type(kind, other) for other in found):
            found.append(kind)
        if len(found) > _MOST:
            return (ANYTHING,)
    return tuple(found)


def _one(kinds: InferredTypes) -> InferredType:
    return kinds[0] if len(kinds) == 1 else ANYTHING


def _live(value: object) -> bool:
    found = template(value)
    return not isinstance(found, Template) or not found.constant
