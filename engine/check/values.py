"""Checks what nodes are given: parameters, expressions, and the userdata keys they read and write."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from typing import Any, cast

import msgspec

from engine.check.finding import Finding
from engine.check.subject import Placed, Subject
from engine.document.conversion import in_words
from engine.document.expression import Template, compile_template
from engine.document.parameter import Parameter
from engine.document.signature import KeySignature
from engine.errors import ExpressionError
from engine.nearness import near_names


def check_values(subject: Subject, entries: Collection[str] | None) -> Iterator[Finding]:
    """Find parameters, keys and expressions that cannot work, and named entries that are not known."""
    visible = _visible_keys(subject)
    for placed in subject.nodes.values():
        if placed.node.kind not in ("state", "behavior"):
            continue
        here = visible[placed.path]
        yield from _check_expressions(subject, placed, here)
        signature = subject.signature(placed.node)
        referred = subject.behavior.references.get(placed.node.behavior or "")
        if signature is not None:
            yield from _check_state_parameters(subject, placed, signature.parameters)
            yield from _check_keys(subject, placed, signature.inputs, signature.outputs)
            if not subject.unknown:
                yield from _check_reads(subject, placed, signature.inputs, here)
        elif referred is not None:
            yield from _check_behavior_parameters(subject, placed, referred.parameters)
            userdata = referred.document.userdata
            yield from _check_keys(subject, placed, userdata, userdata)
            if not subject.unknown:
                yield from _check_reads(subject, placed, {}, here)
        if entries is not None:
            yield from _check_entries(subject, placed, entries)


def _visible_keys(subject: Subject) -> dict[str, frozenset[str]]:
    """Return the names that can be read at each node: parameters, userdata around it, what is written there.

    Children of a concurrency container write into scopes of their own until it ends, so they do
    not see what their siblings write.
    """
    document = subject.behavior.document
    inside: dict[str, frozenset[str]] = {}
    visible: dict[str, frozenset[str]] = {}
    for path, placed in subject.nodes.items():
        outer = frozenset((*document.parameters, *document.userdata))
        visible[path] = outer if placed.parent is None else inside[placed.parent]
        if placed.node.concurrency is not None:
            inside[path] = visible[path].union(placed.node.userdata)
        elif placed.node.children:
            rounds = placed.node.foreach
            own = (rounds.item, *((rounds.index,) if rounds.index else ())) if rounds is not None else ()
            written = [key for child in subject.children(placed) for key in _written(subject, child)]
            inside[path] = visible[path].union(placed.node.userdata, written, own)
    return visible


def _written(subject: Subject, placed: Placed) -> Iterator[str]:
    node = placed.node
    yield from node.outputs.values()
    signature = subject.signature(node)
    if signature is not None:
        yield from (key for key in signature.outputs if key not in node.outputs)


def _check_expressions(subject: Subject, placed: Placed, visible: frozenset[str]) -> Iterator[Finding]:
    for key, value in placed.node.parameters.items():
        template = _template(value)
        if isinstance(template, ExpressionError):
            hint = template.hint or ""
            yield subject.finding("bad-expression", template.message, placed.path, "with", key, hint=hint)
            continue
        for name in sorted(template.names - visible):
            message = f"`{name}` is neither a parameter nor a userdata key that can be read here"
            hint = near_names(name, visible)
            yield subject.finding("undeclared-name", message, placed.path, "with", key, hint=hint)


def _template(value: object) -> Template | ExpressionError:
    try:
        return compile_template(value)
    except ExpressionError as error:
        return error


def _check_state_parameters(
    subject: Subject, placed: Placed, declared: Mapping[str, KeySignature]
) -> Iterator[Finding]:
    required = [name for name, parameter in declared.items() if parameter.required]
    yield from _check_parameter_names(subject, placed, declared, required)
    for name, value in placed.node.parameters.items():
        template = _template(value)
        if name not in declared or isinstance(template, ExpressionError) or not template.constant:
            continue
        try:
            msgspec.convert(value, cast("type[Any]", declared[name].type))
        except msgspec.ValidationError as error:
            what, _, inner = str(error).partition(" - at ")
            keys = ("with", name, *_steps(inner))
            hint = str(declared[name].schema.get("description", ""))
            message = f"parameter `{name}`: {in_words(what)}"
            yield subject.finding("bad-parameter", message, placed.path, *keys, hint=hint)


def _steps(inner: str) -> tuple[str | int, ...]:
    """Return the keys that a msgspec path such as `$.xyz[1]` names, as far as it names them."""
    found: list[str | int] = []
    for name, index in re.findall(r"\.([^.\[\]`]+)|\[(\d+|\.\.\.)\]", inner):
        if index == "...":
            break
        found.append(name or int(index))
    return tuple(found)


def _check_behavior_parameters(
    subject: Subject, placed: Placed, declared: Mapping[str, Parameter]
) -> Iterator[Finding]:
    required = [name for name, parameter in declared.items() if parameter.required]
    yield from _check_parameter_names(subject, placed, declared, required)
    for name, value in placed.node.parameters.items():
        template = _template(value)
        if name not in declared or isinstance(template, ExpressionError) or not template.constant:
            continue
        problem = declared[name].problem(value)
        if problem:
            message = f"parameter `{name}`: {problem}"
            hint = declared[name].description
            yield subject.finding("bad-parameter", message, placed.path, "with", name, hint=hint)


def _check_parameter_names(
    subject: Subject, placed: Placed, declared: Collection[str], required: Collection[str]
) -> Iterator[Finding]:
    what = placed.node.state or placed.node.behavior
    given = placed.node.parameters
    for name in given:
        if name not in declared:
            message = f"`{what}` has no parameter `{name}`"
            keys = ("with", name)
            hint = near_names(name, declared)
            yield subject.finding("unknown-parameter", message, placed.path, *keys, hint=hint, at_key=True)
    for name in required:
        if name not in given:
            message = f"`{what}` needs the parameter `{name}`"
            yield subject.finding("missing-parameter", message, placed.path, hint=f"add `{name}: …` to `with`")


def _check_keys(
    subject: Subject, placed: Placed, inputs: Collection[str], outputs: Collection[str]
) -> Iterator[Finding]:
    what = placed.node.state or placed.node.behavior
    for section, code, given, declared in (
        ("in", "unknown-input", placed.node.inputs, inputs),
        ("out", "unknown-output", placed.node.outputs, outputs),
    ):
        for key in given:
            if key not in declared:
                message = f"`{what}` has no {'input' if section == 'in' else 'output'} key `{key}`"
                hint = near_names(key, declared)
                yield subject.finding(code, message, placed.path, section, key, hint=hint, at_key=True)


def _check_reads(
    subject: Subject, placed: Placed, inputs: Mapping[str, KeySignature], visible: frozenset[str]
) -> Iterator[Finding]:
    mapped = placed.node.inputs
    for key, source in mapped.items():
        if source not in visible:
            message = f"the userdata key `{source}` is not defined here"
            hint = near_names(source, visible)
            yield subject.finding("undefined-key", message, placed.path, "in", key, hint=hint)
    for key, declared in inputs.items():
        if declared.required and key not in mapped and key not in visible:
            message = f"`{placed.node.state}` reads the userdata key `{key}`, which is not defined here"
            hint = f"map it with `in: {{{key}: …}}`; {near_names(key, visible)}"
            yield subject.finding("undefined-key", message, placed.path, hint=hint)


def _check_entries(subject: Subject, placed: Placed, entries: Collection[str]) -> Iterator[Finding]:
    for name, value in placed.node.parameters.items():
        if not isinstance(value, dict):
            continue
        entry = cast("dict[str, object]", value).get("entry")
        if isinstance(entry, str) and "${" not in entry and entry not in entries:
            message = f"there is no entry `{entry}`"
            keys = ("with", name, "entry")
            hint = near_names(entry, entries)
            yield subject.finding("missing-entry", message, placed.path, *keys, hint=hint)
