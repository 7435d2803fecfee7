"""Checks what a behavior declares about itself: parameters, outcomes and success."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from engine.cell.cell_names import all_kinds, is_kind
from engine.check.analyzed_behavior import AnalyzedBehavior
from engine.check.finding import Finding, new_finding
from engine.document.parameter_spec import ParameterSpec
from engine.wording.suggestions import did_you_mean

_NUMERIC = ("number", "integer")


def check_unused(subject: AnalyzedBehavior, used: Collection[str]) -> Iterator[Finding]:
    """Find parameters that are not read; `used` are the names that are."""
    for name in subject.behavior.parameters:
        if name not in used:
            position = subject.behavior.source.position(("parameters", name), of_key=True)
            message = f"the parameter `{name}` is not used"
            hint = f"use it as `${{{name}}}`, or remove it"
            yield new_finding("unused-parameter", message, path=subject.base, position=position, hint=hint)


def check_declarations(subject: AnalyzedBehavior) -> Iterator[Finding]:
    """Find inconsistencies in parameters, `success` and `outcomes`."""
    for name, parameter in subject.behavior.parameters.items():
        yield from _check_parameter(subject, name, parameter)
    declared = subject.behavior.outcomes
    for index, outcome in enumerate(subject.behavior.success):
        if outcome not in declared:
            position = subject.behavior.source.position(("success", index))
            message = f"`success` names `{outcome}`, which is not in `outcomes`"
            hint = did_you_mean(outcome, declared)
            yield new_finding("unknown-success", message, path=subject.base, position=position, hint=hint)
    reached = subject.possible(subject.nodes["root"])
    if reached is None:
        return
    destinations = {*reached, *subject.nodes["root"].targets.values()}
    for index, outcome in enumerate(declared):
        if outcome not in destinations:
            position = subject.behavior.source.position(("outcomes", index))
            message = f"nothing leads to the outcome `{outcome}`"
            hint = "remove it, or add a transition to it"
            yield new_finding("unused-outcome", message, path=subject.base, position=position, hint=hint)


def _check_parameter(subject: AnalyzedBehavior, name: str, parameter: ParameterSpec) -> Iterator[Finding]:
    def found(code: str, message: str, *keys: str | int, hint: str = "") -> Finding:
        position = subject.behavior.source.position(("parameters", name, *keys), of_key=not keys)
        return new_finding(code, message, path=subject.base, position=position, hint=hint)

    low, high = parameter.minimum, parameter.maximum
    if (low is not None or high is not None) and parameter.type not in _NUMERIC:
        key = "minimum" if low is not None else "maximum"
        hint = f"only {' and '.join(_NUMERIC)} have limits"
        yield found("bad-declaration", f"parameter `{name}` is a {parameter.type} and has limits", key, hint=hint)
    if low is not None and high is not None and low > high:
        message = f"parameter `{name}`: the minimum {low:g} is above the maximum {high:g}"
        yield found("bad-declaration", message, "minimum", hint="swap them")
    naming = parameter.naming()
    if naming and parameter.type != "string":
        hint = "only a string names something"
        message = f"parameter `{name}` is a {parameter.type} and names something"
        yield found("bad-declaration", message, next(iter(naming)), hint=hint)
    if len(naming) > 1:
        message = f"parameter `{name}` names a {parameter.cell_name} and an entry"
        yield found("bad-declaration", message, "entry", hint="remove one of them")
    if parameter.cell_name and is_kind(parameter.cell_name) is None:
        message = f"parameter `{name}`: `{parameter.cell_name}` is no kind of thing of a cell"
        hint = did_you_mean(parameter.cell_name, all_kinds())
        yield found("bad-declaration", message, "cell_name", hint=hint)
    for index, choice in enumerate(parameter.choices):
        problem = parameter.problem(choice)
        if problem:
            yield found("bad-declaration", f"choice of parameter `{name}`: {problem}", "choices", index)
    if parameter.required:
        hint = "add a `default`"
        yield found("required-parameter", f"parameter `{name}` must be set for each run", hint=hint)
        return
    problem = parameter.problem(parameter.default)
    if problem:
        yield found("bad-declaration", f"default of parameter `{name}`: {problem}", "default")
