"""Checks the values under `with`, `in` and `out` of nodes: names, types, ranges, well-formed expressions."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Any, cast

import msgspec

from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt, is_constant
from engine.check.finding import Finding
from engine.check.flow.key_reads import assignments, conditions
from engine.document.expression.expression import Template
from engine.document.parameter_spec import ParameterSpec
from engine.document.signature import StateSignature
from engine.errors import ExpressionError
from engine.wording.misfit import Misfit, in_words, suggested_choices
from engine.wording.suggestions import did_you_mean


def check_parameters(
    subject: AnalyzedBehavior, run_parameters: Mapping[str, object] | None = None
) -> Iterator[Finding]:
    """Find unknown parameters and keys, invalid values, and malformed expressions.

    Args:
        subject: The behavior.
        run_parameters: The parameters of a run of it; others, and those that their declaration refuses, have their
            defaults.
    """
    defaults = default_values(subject) | _accepted(subject, run_parameters or {})
    for placed in subject.due:
        signature = subject.signature(placed.node)
        if signature is None:
            yield from _check_node(subject, placed, defaults)
            continue
        check = (check_parameters, signature.state)
        if check in placed.node.clear_of:
            continue
        found = list(_check_node(subject, placed, defaults))
        # Expressions depend on the parameters of the behavior.
        if not found and is_constant(placed.given):
            placed.node.clear_of.add(check)
        yield from found


def _check_node(subject: AnalyzedBehavior, placed: NodeAt, defaults: Mapping[str, object]) -> Iterator[Finding]:
    yield from _check_expressions(subject, placed)
    signature = subject.signature(placed.node)
    referred = subject.referred(placed.node)
    if signature is not None:
        required = [name for name, parameter in signature.parameters.items() if parameter.required]
        names = list(_check_names(subject, placed, signature.parameters, required))
        yield from names
        yield from _check_state(subject, placed, signature, defaults, complete=not names)
        yield from _check_keys(subject, placed, signature.inputs, signature.outputs)
    elif referred is not None:
        parameters = referred.behavior.parameters
        required = [name for name, parameter in parameters.items() if parameter.required]
        yield from _check_names(subject, placed, parameters, required)
        yield from _check_behavior(subject, placed, parameters, defaults)
        userdata = referred.behavior.document.userdata
        yield from _check_keys(subject, placed, userdata, userdata)


def default_values(subject: AnalyzedBehavior) -> dict[str, object]:
    """Return the parameters of a behavior that have a default, as a run without values sees them."""
    declared = subject.behavior.parameters
    return _accepted(subject, {name: each.default for name, each in declared.items() if not each.required})


def _accepted(subject: AnalyzedBehavior, given: Mapping[str, object]) -> dict[str, object]:
    """Return the values that the declared parameters take."""
    declared = subject.behavior.parameters
    return {
        name: declared[name].normal(value)
        for name, value in given.items()
        if name in declared and declared[name].problem(value) is None
    }


def value_by_default(found: Template | ExpressionError, defaults: Mapping[str, object]) -> tuple[bool, object]:
    """Return whether a value is known with these parameters, and the value."""
    if isinstance(found, ExpressionError) or not found.names <= defaults.keys():
        return False, None
    try:
        return True, found.evaluate(defaults)
    except ExpressionError:
        return False, None  # reported by the type checks, or at the latest by a run


def _check_expressions(subject: AnalyzedBehavior, placed: NodeAt) -> Iterator[Finding]:
    for name, found in placed.given.items():
        if isinstance(found, ExpressionError):
            yield subject.finding("bad-expression", found.message, placed.path, "with", name, hint=found.hint or "")
    for several in (conditions(placed), assignments(placed)):
        for keys, found in several.items():
            if isinstance(found, ExpressionError):
                yield subject.finding("bad-expression", found.message, placed.path, *keys, hint=found.hint or "")


def _check_names(
    subject: AnalyzedBehavior, placed: NodeAt, declared: Collection[str], required: Collection[str]
) -> Iterator[Finding]:
    what = placed.node.state or placed.node.behavior
    given = placed.node.parameters
    for name in given:
        if name not in declared:
            message = f"`{what}` has no parameter `{name}`"
            hint = did_you_mean(name, declared)
            yield subject.finding("unknown-parameter", message, placed.path, "with", name, hint=hint, at_key=True)
    for name in required:
        if name not in given:
            message = f"`{what}` requires the parameter `{name}`"
            yield subject.finding("missing-parameter", message, placed.path, hint=f"add `{name}: …` to `with`")


def _check_state(
    subject: AnalyzedBehavior,
    placed: NodeAt,
    signature: StateSignature,
    defaults: Mapping[str, object],
    *,
    complete: bool,
) -> Iterator[Finding]:
    values: dict[str, object] = {}
    faults = 0
    given = placed.given
    for name, found in given.items():
        known, value = value_by_default(found, defaults)
        if not known or name not in signature.parameters:
            continue
        values[name] = value
        declared = signature.parameters[name]
        misfit = _misfit(value, declared.type)
        if misfit is not None:
            faults += 1
            what = in_words(misfit.what)
            constant = isinstance(found, Template) and found.constant
            choices = suggested_choices(declared.type, misfit.path, misfit.refused_choice)
            hint = (choices or str(declared.schema.get("description", ""))) if constant else _WITH_PARAMETERS
            shown = what if constant else f"{value!r}: {what}{f' ({choices})' if choices else ''}"
            keys = ("with", name, *(misfit.path if constant else ()))
            yield subject.finding("bad-parameter", f"parameter `{name}`: {shown}", placed.path, *keys, hint=hint)
    if complete and not faults and len(values) == len(given):
        yield from _check_together(subject, placed, signature, values)


_WITH_PARAMETERS = "this is the value with the parameters of the behavior"


def _check_together(
    subject: AnalyzedBehavior, placed: NodeAt, signature: StateSignature, values: Mapping[str, object]
) -> Iterator[Finding]:
    """Find values that are valid alone but not together, such as two mutually exclusive parameters."""
    misfit = _misfit(dict(values), signature.state)
    if misfit is not None:
        hint = f"see `flexcell states show {signature.name}`"
        yield subject.finding("bad-parameter", misfit.what, placed.path, "with", hint=hint, at_key=True)


def _misfit(value: object, kind: Any) -> Misfit | None:
    """Return what is wrong with a value and where inside it; None when it is valid."""
    try:
        msgspec.convert(value, cast("type[Any]", kind))
    except msgspec.ValidationError as error:
        return Misfit.of(str(error))
    except Exception:
        # The constructor of a custom state may raise anything; a run reports it.
        return None
    return None


def _check_behavior(
    subject: AnalyzedBehavior, placed: NodeAt, declared: Mapping[str, ParameterSpec], defaults: Mapping[str, object]
) -> Iterator[Finding]:
    for name, found in placed.given.items():
        known, value = value_by_default(found, defaults)
        problem = declared[name].problem(value) if known and name in declared else None
        if problem:
            constant = isinstance(found, Template) and found.constant
            hint = declared[name].description if constant else _WITH_PARAMETERS
            message = f"parameter `{name}`: {problem}"
            yield subject.finding("bad-parameter", message, placed.path, "with", name, hint=hint)


def _check_keys(
    subject: AnalyzedBehavior, placed: NodeAt, inputs: Collection[str], outputs: Collection[str]
) -> Iterator[Finding]:
    what = placed.node.state or placed.node.behavior
    for section, code, given, declared in (
        ("in", "unknown-input", placed.node.inputs, inputs),
        ("out", "unknown-output", placed.node.outputs, outputs),
    ):
        for key in given:
            if key not in declared:
                message = f"`{what}` has no {'input' if section == 'in' else 'output'} key `{key}`"
                hint = did_you_mean(key, declared)
                yield subject.finding(code, message, placed.path, section, key, hint=hint, at_key=True)
