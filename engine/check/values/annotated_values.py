"""Walks a value of a document along its declared type, with the annotations of each part."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import groupby
from typing import Any, cast

from msgspec import inspect

Annotations = Mapping[str, object]
"""The content of `extra_json_schema`: unit, kind of entry, kind of name in the cell."""
_NOTHING: Annotations = {}
_DEEPEST = 12


@dataclass(frozen=True, kw_only=True)
class AnnotatedValue:
    """A plain value inside a value, the keys that lead to it, and its annotations."""

    steps: tuple[str | int, ...]
    value: object
    says: Annotations = field(default_factory=dict[str, object])


def annotated_values(annotation: Any, value: object) -> Iterator[AnnotatedValue]:
    """Yield the annotated plain values inside `value`, in document order.

    Args:
        annotation: The declared type; parts that do not match it are skipped.
        value: Plain data. A non-container in the place of a container, such as an expression, is yielded.
    """
    info = _info(annotation)
    if info is not None:
        yield from _parts(info, value, (), _NOTHING)


def is_annotated(annotation: Any) -> bool:
    """Return whether some part of a type has annotations; callers test this before they compute a value."""
    return _info(annotation) is not None


def annotated_lists(annotation: Any, value: object) -> Iterator[tuple[tuple[str | int, ...], list[AnnotatedValue]]]:
    """Yield the same values grouped by list, with the keys that lead to the list or value."""
    for steps, group in groupby(annotated_values(annotation, value), key=_list_of):
        yield steps, list(group)


def _list_of(part: AnnotatedValue) -> tuple[str | int, ...]:
    return part.steps[:-1] if part.steps and isinstance(part.steps[-1], int) else part.steps


@lru_cache(maxsize=4096)
def _info(annotation: Any) -> inspect.Type | None:
    """Return the type; None if no part of it has annotations."""
    found = inspect.type_info(annotation)
    return found if _has_annotations(found, 0) else None


def _has_annotations(here: inspect.Type, depth: int) -> bool:
    if depth > _DEEPEST:
        return False
    return bool(_annotations_of(here)) or any(_has_annotations(inner, depth + 1) for inner in _inside(here))


def _inside(here: inspect.Type) -> Iterator[inspect.Type]:
    if isinstance(here, inspect.Metadata):
        yield here.type
    elif isinstance(here, inspect.UnionType):
        yield from here.types
    elif isinstance(here, inspect.StructType):
        yield from (each.type for each in here.fields)
    elif isinstance(here, inspect.DictType):
        yield here.value_type
    elif isinstance(here, inspect.VarTupleType | inspect.ListType):
        yield here.item_type
    elif isinstance(here, inspect.TupleType):
        yield from here.item_types


def _annotations_of(here: inspect.Type) -> Annotations:
    if not isinstance(here, inspect.Metadata):
        return _NOTHING
    extra = cast("Annotations | None", here.extra_json_schema)  # pyright: ignore[reportUnknownMemberType]
    return {key: found for key, found in (extra or _NOTHING).items() if key != "description"}


def _parts(
    here: inspect.Type, value: object, steps: tuple[str | int, ...], says: Annotations
) -> Iterator[AnnotatedValue]:
    options = list(_options(here, says))
    if isinstance(value, dict):
        mapping = cast("dict[str, object]", value)
        for key, inner in mapping.items():
            for option, merged in options:
                within = _of_key(option, mapping, key)
                if within is not None:
                    of_field = isinstance(option, inspect.StructType)
                    yield from _parts(within, inner, (*steps, key), _NOTHING if of_field else merged)
                    break
    elif isinstance(value, list | tuple):
        items = cast("list[object]", value)
        for index, inner in enumerate(items):
            for option, merged in options:
                within = _of_index(option, index)
                if within is not None:
                    yield from _parts(within, inner, (*steps, index), merged)
                    break
    else:
        merged = {key: found for _, each in reversed(options) for key, found in each.items()}
        if merged:
            yield AnnotatedValue(steps=steps, value=value, says=merged)


def _options(here: inspect.Type, says: Annotations) -> Iterator[tuple[inspect.Type, Annotations]]:
    """Return the alternatives of a type with their annotations; inner annotations take precedence."""
    if isinstance(here, inspect.Metadata):
        yield from _options(here.type, {**says, **_annotations_of(here)})
    elif isinstance(here, inspect.UnionType):
        for option in here.types:
            yield from _options(option, says)
    else:
        yield here, says


def _of_key(here: inspect.Type, value: Mapping[str, object], key: str) -> inspect.Type | None:
    if isinstance(here, inspect.DictType):
        return here.value_type
    if not isinstance(here, inspect.StructType):
        return None
    fields = {each.encode_name: each.type for each in here.fields}
    return fields.get(key) if value.keys() <= fields.keys() or not here.forbid_unknown_fields else None


def _of_index(here: inspect.Type, index: int) -> inspect.Type | None:
    if isinstance(here, inspect.VarTupleType | inspect.ListType):
        return here.item_type
    if isinstance(here, inspect.TupleType):
        return here.item_types[index] if index < len(here.item_types) else None
    return None
