"""Checks that the named entries of a behavior are among those that its store will have."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import lru_cache
from typing import Any, cast

from msgspec import inspect

from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt
from engine.check.finding import Finding
from engine.check.values.annotated_values import annotated_values
from engine.check.values.known_values import known_part
from engine.check.values.parameter_checks import default_values, value_by_default
from engine.document.expression.expression import Template
from engine.errors import ExpressionError
from engine.wording.suggestions import did_you_mean

Entries = Mapping[str, Collection[str]]
"""The names of the entries by kind: joints, pose, dmp, record."""

Steps = tuple[str, ...]


def add_written_entries(entries: Entries, subjects: Iterable[AnalyzedBehavior]) -> Entries:
    """Return the entries and those that states of the behaviors write, as far as their names are known."""
    found = {kind: set(names) for kind, names in entries.items()}
    for kind, name in entries_written(subjects):
        found.setdefault(kind, set()).add(name)
    return found


def entries_written(subjects: Iterable[AnalyzedBehavior]) -> Iterator[tuple[str, str]]:
    """Yield kind and name of the entries that states of the behaviors write, as far as they are known."""
    for subject in subjects:
        yield from _written(subject)


def _written(subject: AnalyzedBehavior) -> Iterator[tuple[str, str]]:
    defaults = default_values(subject)
    for placed in subject.nodes.values():
        signature = subject.signature(placed.node)
        given = placed.given
        for name, parameter in signature.parameters.items() if signature is not None else ():
            for part in annotated_values(parameter.type, known_part(given[name], defaults)) if name in given else ():
                of = str(part.says.get("new_entry_of", ""))
                kind = known_part(given[of], defaults) if of in given else part.says.get("new_entry")
                if isinstance(kind, str) and isinstance(part.value, str):
                    yield kind, part.value


def check_entries(subject: AnalyzedBehavior, entries: Entries) -> Iterator[Finding]:
    """Find names of entries that do not exist, or have another kind than the state reads."""
    defaults = default_values(subject)
    for placed in subject.nodes.values():
        signature = subject.signature(placed.node)
        for name, found in placed.given.items():
            known, value = value_by_default(found, defaults)
            if known and isinstance(value, dict | str) and signature is not None and name in signature.parameters:
                # A field `entry` without a declared kind may name an entry of any kind.
                kinds = {("entry",): "", **entry_fields(signature.parameters[name].type)}
                given = cast("object", value)
                reported = _declared_entries(subject, found)
                kinds = {steps: kind for steps, kind in kinds.items() if (kind, _inside(given, steps)) not in reported}
                yield from _check_value(subject, placed, name, given, kinds, entries)


def _declared_entries(subject: AnalyzedBehavior, found: Template | ExpressionError) -> list[tuple[str, object]]:
    """Return kind and default of the parameters in a value that declare an entry: these are found where they stand."""
    names = found.names if isinstance(found, Template) else ()
    specs = [spec for name, spec in subject.behavior.parameters.items() if name in names]
    return [(spec.entry, spec.default) for spec in specs if spec.entry]


def _check_value(
    subject: AnalyzedBehavior, placed: NodeAt, name: str, value: object, kinds: Mapping[Steps, str], entries: Entries
) -> Iterator[Finding]:
    for steps, kind in kinds.items():
        entry = _inside(value, steps)
        if not isinstance(entry, str) or not entry:
            continue
        if entry in (entries.get(kind, ()) if kind else {each for some in entries.values() for each in some}):
            continue
        others = [other for other, names in entries.items() if entry in names]
        message = f"there is no {f'{kind} ' if kind else ''}entry `{entry}`"
        hint = f"the kind of `{entry}` is {others[0]}" if others else _suggestion(entry, kind, entries)
        yield subject.finding("missing-entry", message, placed.path, "with", name, *steps, hint=hint)


def _suggestion(entry: str, kind: str, entries: Entries) -> str:
    return did_you_mean(entry, entries.get(kind, ()) if kind else [each for some in entries.values() for each in some])


def _inside(value: object, steps: Steps) -> object:
    for step in steps:
        value = cast("dict[str, object]", value).get(step) if isinstance(value, dict) else None
    return value


@lru_cache(maxsize=1024)
def entry_fields(annotation: Any) -> Mapping[Steps, str]:
    """Return the kinds of the fields of a type that name entries, by the steps to the field."""
    found: dict[Steps, str] = {}
    due: list[tuple[Steps, inspect.Type]] = [((), inspect.type_info(annotation))]
    while due:
        steps, here = due.pop()
        if isinstance(here, inspect.Metadata):
            extra = cast("Mapping[str, object] | None", here.extra_json_schema)  # pyright: ignore[reportUnknownMemberType]
            if extra and isinstance(extra.get("entry"), str):
                found[steps] = str(extra["entry"])
            due.append((steps, here.type))
        elif isinstance(here, inspect.UnionType):
            due += [(steps, option) for option in here.types]
        elif isinstance(here, inspect.StructType) and len(steps) < 4:
            due += [((*steps, field.encode_name), field.type) for field in here.fields]
    return found
