"""Types of values as far as they are known before a run, and whether they fit a declared type."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from functools import lru_cache
from typing import Any, cast

import msgspec
from msgspec import inspect

from engine.document.expression.cel_environment import ValueType
from engine.document.expression.cel_expression import as_text
from engine.wording.misfit import explain_misfit


@dataclass(frozen=True)
class ConstantValue:
    """A constant in the document."""

    value: object


@dataclass(frozen=True)
class TypedValue:
    """Some value of a type."""

    type: inspect.Type


@dataclass(frozen=True)
class ListValue:
    """A list in the document of which some items are expressions."""

    items: tuple[InferredType, ...]


@dataclass(frozen=True)
class MappingValue:
    """A mapping in the document of which some values are expressions."""

    items: Mapping[str, InferredType]


InferredType = ConstantValue | TypedValue | ListValue | MappingValue


class TypeFit(IntEnum):
    """Whether a type accepts values of an inferred type: never, depending on the value, always."""

    NO = 0
    MAYBE = 1
    YES = 2


ANYTHING = TypedValue(inspect.AnyType())
TEXT = TypedValue(inspect.StrType())
INTEGER = TypedValue(inspect.IntType())
LIST = TypedValue(inspect.ListType(inspect.AnyType()))

_OPEN = (inspect.AnyType, inspect.CustomType, inspect.ExtType, inspect.RawType)
_LISTS = (inspect.ListType, inspect.VarTupleType, inspect.SetType, inspect.FrozenSetType)
_FROM_TEXT = (
    inspect.EnumType,
    inspect.DateTimeType,
    inspect.DateType,
    inspect.TimeType,
    inspect.TimeDeltaType,
    inspect.UUIDType,
    inspect.DecimalType,
    inspect.BytesType,
    inspect.ByteArrayType,
    inspect.MemoryViewType,
)
_OF_EXPRESSION: Mapping[ValueType, inspect.Type] = {
    "boolean": inspect.BoolType(),
    "integer": inspect.IntType(),
    "number": inspect.FloatType(),
    "text": inspect.StrType(),
    "list": inspect.ListType(inspect.AnyType()),
    "mapping": inspect.DictType(inspect.StrType(), inspect.AnyType()),
    "nothing": inspect.NoneType(),
    "anything": inspect.AnyType(),
}


@lru_cache(maxsize=4096)
def type_of(annotation: Any) -> inspect.Type:
    """Return the type of an annotation, without its limits."""
    return _bare(inspect.type_info(annotation))


def type_of_annotation(annotation: Any) -> InferredType:
    """Return the inferred type for an annotation of a state."""
    return TypedValue(type_of(annotation))


def type_of_expression(found: ValueType) -> InferredType:
    """Return the inferred type of the result of an expression."""
    return TypedValue(_OF_EXPRESSION[found])


def expression_type(kinds: Sequence[InferredType]) -> ValueType:
    """Return the type that an expression may assume for a variable with one of these inferred types."""
    found: list[ValueType] = [_word(kind) for kind in kinds]
    if not found or found.count(found[0]) < len(found):
        return "anything"
    return found[0]


def is_same_type(one: InferredType, other: InferredType) -> bool:
    """Return whether two inferred types are equal; in Python true equals 1, and 1 equals 1.0."""
    if isinstance(one, ConstantValue) and isinstance(other, ConstantValue):
        return type(one.value) is type(other.value) and one.value == other.value
    return one == other


def without_value(kind: InferredType) -> InferredType:
    """Return the inferred type without its constant value."""
    return kind if isinstance(kind, TypedValue) else TypedValue(_OF_EXPRESSION[_word(kind)])


def type_fit(kind: InferredType, annotation: Any) -> TypeFit:
    """Return whether values of an inferred type are accepted by an annotation."""
    if isinstance(kind, ConstantValue):
        return TypeFit.NO if describe_misfit(kind.value, annotation) else TypeFit.YES
    return _fit(kind, type_of(annotation))


def describe_misfit(value: object, annotation: Any) -> str:
    """Return what is wrong with a document value for an annotation; empty if it is valid."""
    try:
        msgspec.convert(value, cast("type[Any]", annotation))
    except msgspec.ValidationError as error:
        return explain_misfit(error, annotation)
    return ""


def describe_inferred_type(kind: InferredType) -> str:
    """Return the name of an inferred type for a message."""
    if isinstance(kind, ConstantValue):
        shown = as_text(kind.value)
        return f"`{shown if len(shown) <= 40 else f'{shown[:37]}…'}`"
    if isinstance(kind, ListValue):
        return f"a list with {_and_so_on([describe_inferred_type(item) for item in kind.items])}"
    if isinstance(kind, MappingValue):
        entries = [f"{key}: {describe_inferred_type(item)}" for key, item in kind.items.items()]
        return f"a mapping with {_and_so_on(entries)}"
    return describe_type(kind.type)


def describe_type(found: inspect.Type) -> str:
    """Return the name of a type in the terms of documents."""
    match found:
        case inspect.BoolType():
            return "true or false"
        case inspect.IntType():
            return "an integer"
        case inspect.FloatType():
            return "a number"
        case inspect.StrType():
            return "text"
        case inspect.NoneType():
            return "nothing"
        case inspect.LiteralType():
            return f"one of {', '.join(str(value) for value in found.values)}"
        case inspect.StructType() | inspect.DataclassType() | inspect.TypedDictType() | inspect.NamedTupleType():
            return str(found.cls.__name__)
        case inspect.DictType():
            return "a mapping"
        case inspect.UnionType():
            return " or ".join(dict.fromkeys(describe_type(option) for option in found.types))
        case inspect.ListType() | inspect.VarTupleType() | inspect.SetType() | inspect.FrozenSetType():
            inner = describe_type(found.item_type)
            return f"a list of {_PLURALS.get(inner, 'values')}"
        case inspect.TupleType():
            return f"a list of {len(found.item_types)} values"
        case _:
            return "any value"


def _and_so_on(shown: Sequence[str]) -> str:
    return ", ".join([*shown[:4], "…"] if len(shown) > 4 else shown)


_PLURALS = {"a number": "numbers", "an integer": "integers", "text": "texts", "true or false": "truth values"}


def item_types(kind: InferredType) -> tuple[InferredType, ...]:
    """Return the types of the items of a list; none if it is not a list or is empty."""
    if isinstance(kind, ConstantValue):
        value = kind.value
        return tuple(ConstantValue(item) for item in cast("list[object]", value)) if isinstance(value, list) else ()
    if isinstance(kind, ListValue):
        return kind.items
    if isinstance(kind, MappingValue):
        return ()
    options = kind.type.types if isinstance(kind.type, inspect.UnionType) else (kind.type,)
    found: list[InferredType] = []
    for option in options:
        if isinstance(option, _LISTS):
            found.append(TypedValue(option.item_type))
        elif isinstance(option, inspect.TupleType):
            found += [TypedValue(item) for item in option.item_types]
        elif isinstance(option, _OPEN):
            found.append(ANYTHING)
    return tuple(found)


def _bare(found: inspect.Type) -> inspect.Type:
    while isinstance(found, inspect.Metadata):
        found = found.type
    if isinstance(found, inspect.UnionType):
        return inspect.UnionType(tuple(_bare(option) for option in found.types))
    return found


def _word(kind: InferredType) -> ValueType:
    if isinstance(kind, ConstantValue):
        value = kind.value
        if isinstance(value, bool):
            return "boolean"
        by_class: dict[type, ValueType] = {int: "integer", float: "number", str: "text", list: "list", dict: "mapping"}
        return by_class.get(type(value), "anything")
    if isinstance(kind, ListValue):
        return "list"
    return "mapping" if isinstance(kind, MappingValue) else _word_of_type(kind.type)


def _word_of_type(found: inspect.Type) -> ValueType:
    match found:
        case inspect.BoolType():
            return "boolean"
        case inspect.IntType():
            return "integer"
        case inspect.FloatType():
            return "number"
        case inspect.StrType():
            return "text"
        case inspect.ListType() | inspect.VarTupleType() | inspect.TupleType():
            return "list"
        case inspect.DictType() | inspect.StructType():
            return "mapping"
        case _:
            return "anything"


def _type_of_constant(value: object) -> inspect.Type:
    """Return the type of a value inside a list or mapping that has expressions in it."""
    return _OF_EXPRESSION[_word(ConstantValue(value))] if value is not None else inspect.NoneType()


def _fit(kind: InferredType, due: inspect.Type) -> TypeFit:
    due = _bare(due)
    if isinstance(due, inspect.UnionType):
        return max(_fit(kind, option) for option in due.types)
    if isinstance(due, _OPEN):
        return TypeFit.YES
    if isinstance(kind, ConstantValue):
        return _fit_constant(kind.value, due)
    if isinstance(kind, ListValue):
        return _fit_items(kind.items, due)
    if isinstance(kind, MappingValue):
        return _fit_fields(kind.items, due)
    return _fit_type(kind.type, due)


def _fit_constant(value: object, due: inspect.Type) -> TypeFit:
    if isinstance(value, list | tuple):
        return _fit_items([ConstantValue(item) for item in cast("list[object]", value)], due)
    if isinstance(value, dict):
        return _fit_fields({key: ConstantValue(item) for key, item in cast("dict[str, object]", value).items()}, due)
    if isinstance(due, inspect.LiteralType):
        return TypeFit.YES if value in due.values else TypeFit.NO
    # Limits are not checked here: the value contains expressions, and a run checks it completely.
    return min(_fit_type(_type_of_constant(value), due), TypeFit.MAYBE)


def _fit_items(items: Sequence[InferredType], due: inspect.Type) -> TypeFit:
    if isinstance(due, _LISTS):
        return min((_fit(item, due.item_type) for item in items), default=TypeFit.YES)
    if isinstance(due, inspect.TupleType):
        if len(items) != len(due.item_types):
            return TypeFit.NO
        return min((_fit(item, t) for item, t in zip(items, due.item_types, strict=True)), default=TypeFit.YES)
    return TypeFit.NO


def _fit_fields(items: Mapping[str, InferredType], due: inspect.Type) -> TypeFit:
    if isinstance(due, inspect.DictType):
        return min((_fit(item, due.value_type) for item in items.values()), default=TypeFit.YES)
    if isinstance(due, inspect.StructType):
        fields = {field.encode_name: field for field in due.fields}
        if due.forbid_unknown_fields and not set(items) <= set(fields):
            return TypeFit.NO
        if any(field.required and name not in items for name, field in fields.items()):
            return TypeFit.NO
        return min(
            (_fit(item, fields[name].type) for name, item in items.items() if name in fields), default=TypeFit.YES
        )
    return TypeFit.MAYBE if isinstance(due, inspect.DataclassType | inspect.TypedDictType) else TypeFit.NO


def _fit_type(found: inspect.Type, due: inspect.Type) -> TypeFit:
    found = _bare(found)
    if isinstance(found, inspect.UnionType):
        fits = {_fit(TypedValue(option), due) for option in found.types}
        return fits.pop() if len(fits) == 1 else TypeFit.MAYBE
    if isinstance(found, _OPEN):
        return TypeFit.MAYBE
    if isinstance(found, inspect.LiteralType):
        return min((_fit_constant(value, due) for value in found.values), default=TypeFit.MAYBE)
    if isinstance(due, _LISTS) and isinstance(found, _LISTS):
        return _fit(TypedValue(found.item_type), due.item_type)
    if isinstance(due, (*_LISTS, inspect.TupleType)) and isinstance(found, inspect.TupleType):
        return _fit_items([TypedValue(item) for item in found.item_types], due)
    if isinstance(due, inspect.TupleType) and isinstance(found, _LISTS):
        return min((_fit(TypedValue(found.item_type), item) for item in due.item_types), default=TypeFit.MAYBE)
    return _fit_plain(found, due)


def _fit_plain(found: inspect.Type, due: inspect.Type) -> TypeFit:
    match found, due:
        case inspect.IntType(), inspect.FloatType():
            return TypeFit.YES
        case inspect.StrType(), _ if isinstance(due, (inspect.LiteralType, *_FROM_TEXT)):
            return TypeFit.MAYBE
        case _ if isinstance(found, _FROM_TEXT) or isinstance(due, _FROM_TEXT):
            return TypeFit.MAYBE
        case inspect.IntType() | inspect.BoolType() | inspect.NoneType(), inspect.LiteralType():
            return TypeFit.MAYBE
        case inspect.DictType(), inspect.StructType() | inspect.DataclassType() | inspect.TypedDictType():
            return TypeFit.MAYBE
        case inspect.StructType(), inspect.StructType():
            return TypeFit.YES if issubclass(found.cls, due.cls) else TypeFit.NO
        case inspect.DictType(), inspect.DictType():
            return _fit(TypedValue(found.value_type), due.value_type)
        case _:
            return TypeFit.YES if type(found) is type(due) else TypeFit.NO
