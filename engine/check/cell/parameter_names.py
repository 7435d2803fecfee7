"""What the parameters of a behavior name: robots, parts, entries and more, declared or inferred from their uses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from engine.cell.cell_names import CellNames, is_kind
from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt, analyze_behaviors
from engine.check.cell.entry_references import Entries
from engine.check.finding import Finding, new_finding
from engine.check.values.annotated_values import Annotations, annotated_values, is_annotated
from engine.check.values.known_values import UnknownValue, known_part
from engine.document.behavior import Behavior
from engine.document.expression.expression import Template
from engine.document.parameter_spec import ParameterSpec
from engine.document.state_catalogue import Catalogue
from engine.wording.suggestions import did_you_mean

_NAMING = ("cell_name", "cell_label", "entry")
_KEPT = (*_NAMING, "or")
"""`or` are names that are always valid beside those of the cell."""
_Keys = tuple[str | int, ...]


def parameter_annotations(subject: AnalyzedBehavior) -> dict[str, Annotations]:
    """Return what each text parameter names, in the words of the parameters of states; what names nothing is left out.

    A parameter without a declaration names what all states name that take it as it is; nothing where these differ.
    """
    declared = {name: spec.naming() for name, spec in subject.behavior.parameters.items()}
    uses: dict[str, list[Annotations]] = {}
    for placed in subject.nodes.values():
        for name, says in _uses(subject, placed):
            uses.setdefault(name, []).append({word: says[word] for word in _KEPT if word in says})
    found: dict[str, Annotations] = {}
    for name, spec in subject.behavior.parameters.items():
        inferred = uses.get(name, [])
        if declared[name]:
            found[name] = declared[name]
        elif spec.type == "string" and not spec.choices and inferred and all(each == inferred[0] for each in inferred):
            found[name] = inferred[0]
    return found


def parameter_naming(behavior: Behavior, catalogue: Catalogue) -> dict[str, Annotations]:
    """Return what each text parameter of a behavior names; see `parameter_annotations`."""
    return parameter_annotations(analyze_behaviors(behavior, catalogue)[0])


def _uses(subject: AnalyzedBehavior, placed: NodeAt) -> Iterator[tuple[str, Annotations]]:
    """Yield each parameter that a node takes over as it is, with what it names there."""
    signature, referred = subject.signature(placed.node), subject.referred(placed.node)
    inside = parameter_annotations(referred) if referred is not None else {}
    for name, given in placed.given.items():
        if not isinstance(given, Template) or given.constant:
            continue
        written = known_part(given, {})
        if signature is not None and name in signature.parameters and is_annotated(signature.parameters[name].type):
            for part in annotated_values(signature.parameters[name].type, written):
                # What is below another name has no meaning without it.
                key = part.value.key if isinstance(part.value, UnknownValue) else None
                if key is not None and "of" not in part.says and any(word in part.says for word in _NAMING):
                    yield key, part.says
        elif isinstance(written, UnknownValue) and written.key is not None and name in inside:
            yield written.key, inside[name]


def check_declared_names(subject: AnalyzedBehavior, names: CellNames, given: Mapping[str, object]) -> Iterator[Finding]:
    """Find values of parameters that name something which the cell does not have.

    Args:
        subject: The behavior that is run.
        names: The names of the cell.
        given: The parameters of a run; others have their defaults.
    """
    for name, spec in subject.behavior.parameters.items():
        kind = is_kind(spec.cell_name)
        for keys, value in _values(name, spec, given) if kind is not None else ():
            if kind is not None and not names.has(kind, value):
                is_certain = keys[:1] != ("choices",) and not names.may_come(kind, value)
                code = "unknown-in-cell" if is_certain else "maybe-unknown-in-cell"
                message = f"{names.missing(kind, value)}, {_source(name, keys)}"
                yield _finding(subject, code, message, name, keys, hint=names.advice(kind, value))


def check_declared_entries(subject: AnalyzedBehavior, entries: Entries) -> Iterator[Finding]:
    """Find defaults and choices of parameters that name entries which do not exist."""
    for name, spec in subject.behavior.parameters.items():
        for keys, value in _values(name, spec, {}) if spec.entry else ():
            if value not in entries.get(spec.entry, ()):
                message = f"there is no {spec.entry} entry `{value}`, {_source(name, keys)}"
                hint = did_you_mean(value, entries.get(spec.entry, ()))
                yield _finding(subject, "missing-entry", message, name, keys, hint=hint)


def _finding(subject: AnalyzedBehavior, code: str, message: str, name: str, keys: _Keys, *, hint: str) -> Finding:
    position = subject.behavior.source.position(("parameters", name, *keys), of_key=not keys)
    return new_finding(code, message, path=subject.base, position=position, hint=hint)


def _source(name: str, keys: _Keys) -> str:
    what = {"default": "the default", "choices": "a choice"}.get(str(keys[0]), "") if keys else "the value"
    return f"{what} of the parameter `{name}`"


def _values(name: str, spec: ParameterSpec, given: Mapping[str, object]) -> Iterator[tuple[_Keys, str]]:
    if name in given:
        values: list[tuple[_Keys, object]] = [((), given[name])]
    else:
        values = [] if spec.required else [(("default",), spec.default)]
        values += [(("choices", index), each) for index, each in enumerate(spec.choices) if each != spec.default]
    yield from ((keys, value) for keys, value in values if isinstance(value, str) and value)
