"""Checks that the names of robots, tools, parts, frames and other items in a behavior are in its cell."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, cast

from engine.cell.cell_names import CellNameKind, CellNames, is_kind
from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt
from engine.check.cell.parameter_names import check_declared_names
from engine.check.finding import Finding
from engine.check.flow.key_reads import only_name
from engine.check.flow.type_inference import TypeInference
from engine.check.flow.value_type import ConstantValue
from engine.check.values.annotated_values import AnnotatedValue, annotated_values, is_annotated
from engine.check.values.joint_targets import check_joint_targets
from engine.check.values.known_values import UnknownValue, known_part
from engine.check.values.parameter_checks import default_values
from engine.document.expression.expression import Template
from engine.document.signature import StateSignature
from engine.errors import ExpressionError


@dataclass(frozen=True, kw_only=True)
class _Use:
    """A name in a node, and the kind of cell item that it refers to.

    With an `owner` the name belongs to that item: a link of a robot. `besides` are names that are always valid.
    """

    placed: NodeAt
    keys: tuple[str | int, ...]
    value: object
    kind: CellNameKind
    key: str | None
    """The parameter or userdata key, if the name is an expression with only that key."""
    owner: object = None
    besides: Sequence[str] = ()


@dataclass(frozen=True, kw_only=True)
class _Due:
    """The kind of name that a behavior expects as a parameter, derived from its uses inside."""

    kind: CellNameKind
    besides: Sequence[str]


@dataclass
class CellNameCheck:
    """Compares the names in behaviors with those of a cell.

    Args:
        names: The names of the cell.
        subjects: The behavior under check, followed by those that it refers to.
        parameters: The parameters of a run by name; others have their defaults.
    """

    names: CellNames
    subjects: Sequence[AnalyzedBehavior]
    parameters: Mapping[str, object] = field(default_factory=dict[str, object])
    _due: dict[int, Mapping[str, _Due]] = field(default_factory=dict[int, "Mapping[str, _Due]"])
    _added: list[frozenset[str] | None] = field(default_factory=list["frozenset[str] | None"])

    def check(self, subject: AnalyzedBehavior, resolver: TypeInference | None) -> Iterator[Finding]:
        """Find names in one of the behaviors that are not in the cell, and invalid joint angles.

        Args:
            subject: The behavior.
            resolver: The inferred types of its userdata; None to skip userdata.
        """
        top = subject is self.subjects[0]
        known = {**default_values(subject), **self.parameters} if top else {}
        yield from check_joint_targets(subject, self.names.joints, known)
        if top:
            yield from check_declared_names(subject, self.names, self.parameters)
        for use in self._uses(subject, known):
            yield from self._beyond_driver(subject, use)
            spec = subject.behavior.parameters.get(use.key) if use.key is not None else None
            if top and spec is not None and spec.cell_name == use.kind:
                continue  # found where it is declared
            if not isinstance(use.value, UnknownValue):
                yield from self._compared(subject, use, use.value, self._origin(subject, use))
            # The initial userdata of a referred behavior depends on each reference.
            if resolver is not None and top and use.key is not None and use.key not in self.parameters:
                yield from self._reaching(subject, use, use.key, resolver)

    def _beyond_driver(self, subject: AnalyzedBehavior, use: _Use) -> Iterator[Finding]:
        """Find a state that needs more than the driver of its device can do."""
        signature = subject.signature(use.placed.node)
        if signature is None or not isinstance(use.value, str) or use.owner is not None:
            return
        reason = self.names.beyond_driver(use.kind, use.value, signature.state.skills)
        if reason:
            message = f"{signature.name} cannot be executed by `{use.value}`: {reason}"
            hint = "use another device, or simulate it with `driver: sim`"
            at_key = use.keys == ("with",)
            yield subject.finding("beyond-driver", message, use.placed.path, *use.keys, hint=hint, at_key=at_key)

    def _compared(
        self, subject: AnalyzedBehavior, use: _Use, value: object, origin: str, *, maybe: bool = False
    ) -> Iterator[Finding]:
        name = self._name(use, value)
        if name is None or self.names.has(use.kind, name):
            return
        more: frozenset[str] | None = frozenset()
        if self.names.may_come(use.kind, name):
            maybe = True
            more = self._added_names()
            if more is None or name in more:
                return
        code = "maybe-unknown-in-cell" if maybe else "unknown-in-cell"
        message = self.names.missing(use.kind, name) + origin
        hint = self.names.advice(use.kind, name, more=more)
        yield subject.finding(code, message, use.placed.path, *use.keys, hint=hint, at_key=use.keys == ("with",))

    def _reaching(self, subject: AnalyzedBehavior, use: _Use, key: str, resolver: TypeInference) -> Iterator[Finding]:
        """Compare the possible values of a key, as far as the document contains them."""
        kinds = [kind for _, kind in resolver.before(use.placed.path, key)]
        values = [kind.value for kind in kinds if isinstance(kind, ConstantValue)]
        wrong = [value for value in values if (name := self._name(use, value)) and not self.names.has(use.kind, name)]
        always = len(wrong) == len(kinds)
        for value in wrong:
            # A wrong default is already reported.
            if value != use.value:
                origin = f", which `${{{key}}}` {'is' if always else 'may be'}"
                yield from self._compared(subject, use, value, origin, maybe=not always)

    def _name(self, use: _Use, value: object) -> str | None:
        """Return the name as the cell lists it; None if there is no name to check."""
        is_number = use.kind in ("output", "input") and isinstance(value, int) and not isinstance(value, bool)
        if not (is_number or isinstance(value, str)) or value == "" or value in use.besides:
            return None
        if use.owner is None:
            return str(value)
        # A missing owner is already reported; its parts are not checked.
        exists = isinstance(use.owner, str) and any(use.owner in names for names in self.names.by_kind.values())
        return f"{use.owner}/{value}" if exists else None

    def _origin(self, subject: AnalyzedBehavior, use: _Use) -> str:
        found = use.placed.given.get(str(use.keys[1])) if len(use.keys) > 1 else None
        if not isinstance(found, Template) or found.constant:
            return ""
        is_given = any(name in self.parameters for name in found.names)
        written = found.value if isinstance(found.value, str) else f"${{{', '.join(sorted(found.names))}}}"
        return f", which `{written}` is" + ("" if is_given else " by default")

    def _uses(self, subject: AnalyzedBehavior, known: Mapping[str, object]) -> Iterator[_Use]:
        for placed in subject.nodes.values():
            signature = subject.signature(placed.node)
            referred = subject.referred(placed.node)
            if signature is not None:
                yield from _of_state(placed, signature, known)
            elif referred is not None:
                yield from self._of_reference(subject, placed, referred, known)

    def _of_reference(
        self, subject: AnalyzedBehavior, placed: NodeAt, referred: AnalyzedBehavior, known: Mapping[str, object]
    ) -> Iterator[_Use]:
        given = placed.given
        defaults = default_values(referred)
        for name, due in self._parameters(referred).items():
            if name in given:
                value, keys = known_part(given[name], known), ("with", name)
            else:
                value, keys = defaults.get(name), ()
            key = only_name(given[name]) if name in given else None
            yield _Use(placed=placed, keys=keys, value=value, kind=due.kind, key=key, besides=due.besides)

    def _parameters(self, subject: AnalyzedBehavior) -> Mapping[str, _Due]:
        """Return the kinds of names that a behavior expects for its parameters."""
        if id(subject) not in self._due:
            specs = subject.behavior.parameters.items()
            kinds = {name: is_kind(spec.cell_name) for name, spec in specs}
            found = {name: _Due(kind=kind, besides=()) for name, kind in kinds.items() if kind is not None}
            for use in self._uses(subject, {}):
                if use.key in subject.behavior.parameters and use.owner is None:
                    found.setdefault(use.key, _Due(kind=use.kind, besides=use.besides))
            self._due[id(subject)] = found
        return self._due[id(subject)]

    def _added_names(self) -> frozenset[str] | None:
        """Return the names that the behaviors add to the cell; None if they are known only in a run."""
        if not self._added:
            found = [each for subject in self.subjects for each in _added(subject)]
            self._added.append(
                None if any(isinstance(each, UnknownValue) for each in found) else frozenset(map(str, found))
            )
        return self._added[0]


def _of_state(placed: NodeAt, signature: StateSignature, known: Mapping[str, object]) -> Iterator[_Use]:
    given = placed.given
    for name, parameter in signature.parameters.items():
        if not is_annotated(parameter.type):
            continue
        found = given.get(name)
        value = known_part(found, known) if found is not None else parameter.default
        written = {each.steps: each.value for each in _expressions(parameter.type, found)}
        for part in annotated_values(parameter.type, value):
            kind, of = is_kind(part.says.get("cell_name")), part.says.get("of")
            # A class default suits some robot, not necessarily the one in this node.
            if kind is None or (found is None and of not in given):
                continue
            source = written.get(part.steps)
            yield _Use(
                placed=placed,
                keys=("with", name, *part.steps) if found is not None else ("with",),
                value=part.value,
                kind=kind,
                key=source.key if isinstance(source, UnknownValue) else None,
                owner=known_part(given[str(of)], known) if of in given else UnknownValue() if of else None,
                besides=cast("Sequence[str]", part.says.get("or", ())),
            )


def _expressions(annotation: Any, found: Template | ExpressionError | None) -> Iterator[AnnotatedValue]:
    """Yield the parts of a value as written, if it contains expressions."""
    if isinstance(found, Template) and not found.constant:
        yield from annotated_values(annotation, known_part(found, {}))


def _added(subject: AnalyzedBehavior) -> Iterator[object]:
    """Return the names of items that states of a behavior add to the cell."""
    for placed in subject.nodes.values():
        signature = subject.signature(placed.node)
        for name, parameter in signature.parameters.items() if signature is not None else ():
            found = placed.given.get(name)
            for part in annotated_values(parameter.type, known_part(found, {})) if found is not None else ():
                if "new_cell_name" in part.says:
                    yield part.value
