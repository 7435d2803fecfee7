"""Says what is wrong with a value for a type, in the words of documents, and what would fit instead."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import cache
from typing import cast

import msgspec
from msgspec import inspect

from engine.wording.suggestions import did_you_mean

DataPath = tuple[str | int, ...]
"""Keys and indices from a document or value inward."""

_AT = re.compile(r"^(?P<what>.*?)(?: - at (?:`key` in )?`(?P<path>\$.*)`)?$", re.DOTALL)
_STEP = re.compile(r"\.([^.\[\]]+)|\[(\d+)\]")
_NO_CHOICE = re.compile(r"Invalid enum value '?(.*?)'?", re.DOTALL)
_TYPES = {
    "object": "mapping",
    "array": "list",
    "str": "text",
    "float": "number",
    "int": "integer",
    "bool": "boolean",
    "null": "nothing",
}


class Misfit(msgspec.Struct, frozen=True, kw_only=True):
    """One complaint of msgspec: `what` in its words, and the `path` inside the value that it is about."""

    what: str
    path: DataPath

    @classmethod
    def of(cls, complaint: str) -> Misfit:
        """Return the parts of a complaint such as ``Expected `float`, got `str` - at `$.xyz[1]` ``."""
        match = cast("re.Match[str]", _AT.match(complaint))
        # A key of a mapping is not named but `[...]`; what is inside has no path.
        known = (match["path"] or "$").partition("[...]")[0]
        steps = cast("list[tuple[str, str]]", _STEP.findall(known))
        return cls(what=match["what"], path=tuple(name or int(index) for name, index in steps))

    @property
    def refused_choice(self) -> str | None:
        """The value that is none of the choices, as text; None for another complaint."""
        match = _NO_CHOICE.fullmatch(self.what)
        return match[1] if match else None


def explain_misfit(error: msgspec.ValidationError, kind: object, *, key: str = "") -> str:
    """Return what is wrong with a value (of `key`) for the type `kind`, and the choices where it is none of them."""
    misfit = Misfit.of(str(error))
    text = in_words(misfit.what)
    instead = suggested_choices(kind, misfit.path, misfit.refused_choice)
    place = place_text((key, *misfit.path) if key else misfit.path)
    where = f"`{place}`: " if place else ""
    return f"{where}{text}{f' ({instead})' if instead else ''}"


def suggested_choices(kind: object, path: DataPath, refused: str | None) -> str | None:
    """Return what may stand at `path` of a value of type `kind` instead of a refused choice; None if unknown."""
    if refused is None:
        return None
    choices = [str(each) for option in types_at(kind, path) for each in _choices(option)]
    return did_you_mean(refused, choices) if choices else None


def place_text(path: DataPath) -> str:
    """Return a place inside a value as text, such as `waypoints[1].speed`."""
    return "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in path).removeprefix(".")


def in_words(what: str) -> str:
    """Return a message of msgspec with the type names of the document format."""

    def types(match: re.Match[str]) -> str:
        names = match[1].split(" | ")
        return " or ".join(_TYPES[name] for name in names) if _TYPES.keys() >= set(names) else match[0]

    text = re.sub(r"expected `str` matching regex .*", "not in the allowed form", what, flags=re.IGNORECASE | re.DOTALL)
    text = re.sub(r"^Invalid enum value (.*)", r"there is no choice \1", text)
    text = re.sub(r"`([a-z |]+)`", types, text)
    return f"{text[:1].lower()}{text[1:]}"


def types_at(kind: object, path: DataPath) -> list[inspect.Type]:
    """Return the types that a value at `path` of a value of type `kind` may have, without unions and annotations."""
    here: list[inspect.Type] = list(_options(_type_of(kind)))
    for step in path:
        here = [option for inner in declared_in(here, step) for option in _options(inner)]
    return here


def declared_in(containers: Iterable[inspect.Type], step: str | int) -> list[inspect.Type]:
    """Return what is declared at a key or index of containers, with its annotations."""
    return [inner for container in containers for inner in _inside(container, step)]


@cache
def _type_of(kind: object) -> inspect.Type:
    return inspect.type_info(kind)


def _choices(option: inspect.Type) -> tuple[object, ...]:
    return tuple(option.values) if isinstance(option, inspect.LiteralType) else ()


def _options(kind: inspect.Type) -> Iterator[inspect.Type]:
    if isinstance(kind, inspect.Metadata):
        yield from _options(kind.type)
    elif isinstance(kind, inspect.UnionType):
        for option in kind.types:
            yield from _options(option)
    else:
        yield kind


def _inside(kind: inspect.Type, step: str | int) -> Iterator[inspect.Type]:
    if isinstance(kind, inspect.StructType):
        yield from (f.type for f in kind.fields if f.encode_name == step)
    elif isinstance(kind, inspect.DictType):
        yield kind.value_type
    elif isinstance(kind, inspect.VarTupleType | inspect.ListType):
        yield kind.item_type
