"""The JSON Schemas of the bodies and frames: for the OpenAPI description, and for the types of the page."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from types import NoneType, UnionType
from typing import Any, get_args

import msgspec
from msgspec import inspect

from engine.document import any_value

Schema = dict[str, Any]
_REFERENCE = "#/components/schemas/{name}"


@dataclass(frozen=True)
class BodyTypes:
    """The types that cross to or from a client, of one router or of all: what it sends and what it takes."""

    sent: list[Any] = field(default_factory=list[Any])
    taken: list[Any] = field(default_factory=list[Any])

    def __add__(self, other: BodyTypes) -> BodyTypes:
        return BodyTypes([*self.sent, *other.sent], [*self.taken, *other.taken])


def reference_to(kind: Any) -> Schema:
    """Return the schema of a body, which refers to the components for every struct; `A | B` is one of two structs."""
    schemas, _ = _described(list(alternatives(kind)))
    return schemas[0] if len(schemas) == 1 else {"anyOf": list(schemas)}


def alternatives(kind: Any) -> tuple[Any, ...]:
    """Return the structs of a union, which msgspec could not tell apart when it reads them; else the type itself."""
    options = get_args(kind)
    return options if isinstance(kind, UnionType) and NoneType not in options else (kind,)


def component_schemas(types: BodyTypes) -> dict[str, Schema]:
    """Return the schema of every struct in the bodies, by its name.

    The server sends every field of what it only sends: there no field is optional, although it has a default.
    """
    _, components = _described([*types.sent, *types.taken])
    taken = {each.__name__ for each in _structs(types.taken)}
    for each in _structs(types.sent):
        config = getattr(each, "__struct_config__", None)
        if each.__name__ in components and each.__name__ not in taken and not (config and config.omit_defaults):
            schema = components[each.__name__]
            schema["required"] = list(schema.get("properties", ()))
    return components


def _described(types: list[Any]) -> tuple[tuple[Schema, ...], dict[str, Schema]]:
    return msgspec.json.schema_components(types, schema_hook=any_value, ref_template=_REFERENCE)


def _structs(types: Iterable[Any]) -> Iterator[type]:
    """Return every struct and dataclass that these types reach."""
    waiting = list(inspect.multi_type_info(types))
    seen: set[type] = set()
    while waiting:
        match waiting.pop():
            case inspect.StructType(cls=cls, fields=fields) | inspect.DataclassType(cls=cls, fields=fields):
                if cls not in seen:
                    seen.add(cls)
                    waiting.extend(each.type for each in fields)
            case inspect.UnionType(types=options):
                waiting.extend(options)
            case inspect.TupleType(item_types=items):
                waiting.extend(items)
            case inspect.DictType(key_type=key, value_type=value):
                waiting.extend((key, value))
            case (
                inspect.Metadata(type=inner) | inspect.VarTupleType(item_type=inner) | inspect.ListType(item_type=inner)
            ):
                waiting.append(inner)
            case _:
                pass
    return iter(seen)
