"""Finds every mismatch between plain data and a model, and returns the data without the mismatches.

A mistake does not hide the others: a mistyped key is read as the most similar valid one, an unknown key is removed,
an invalid value is replaced by its default or a placeholder. The search ends after `MAX_MISTAKES`.
"""

from __future__ import annotations

import types
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, Final, Literal, Union, cast, get_args, get_origin

import msgspec
from msgspec.structs import FieldInfo

from engine.document.text.yaml_source import DataPath, DocumentSource, PositionTree
from engine.wording.suggestions import close_names

MAX_MISTAKES = 100
"""Maximum number of reported mistakes of one document."""
_LONGEST_KEY = 100
_ALIKE = 0.7
UNREADABLE = "unreadable"
"""Placeholder for unreadable text."""

Plain = dict[str, object]
Repair = Callable[[Plain], Plain]


@dataclass(frozen=True, kw_only=True)
class DocumentMistake:
    """A mismatch in the data: `path` leads to the value, or to the wrong or missing key.

    `complaint` is the msgspec message for the value; empty for unknown or missing keys. `meant` is the valid key as
    which an unknown key was read. All other steps of the path are corrected keys.
    """

    path: DataPath
    fault: Literal["value", "key", "unknown", "missing"]
    complaint: str = ""
    meant: str = ""


class TooManyMistakes(Exception):
    """The search was stopped."""


class _Broken:
    """Placeholder for an unusable value."""


_BROKEN: Final = _Broken()


@dataclass
class MistakeCollector:
    """One search in one document.

    Args:
        repairs: By model, a function that completes the remaining data after a removal.
    """

    repairs: Mapping[type, Repair] = field(default_factory=dict[type, Repair])
    mistakes: list[DocumentMistake] = field(default_factory=list[DocumentMistake])

    def sift(self, value: object, kind: Any) -> object:
        """Return the value without its mistakes; None if nothing is left or there are too many.

        The mistakes found are in `mistakes`, in the order of the data.
        """
        try:
            kept = self._value(value, kind, ())
        except TooManyMistakes:
            return None
        return None if kept is _BROKEN else kept

    def _value(self, value: object, kind: Any, path: DataPath) -> object:
        complaint = _complaint(value, kind)
        if complaint is None:
            return value
        known = len(self.mistakes)
        kept = self._container(value, kind, path)
        if len(self.mistakes) == known:
            # The value is wrong as a whole, or its mistakes cannot be located.
            self._note(DocumentMistake(path=path, fault="value", complaint=complaint))
            return _BROKEN
        return kept if kept is not _BROKEN and _complaint(kept, kind) is None else _BROKEN

    def _container(self, value: object, kind: Any, path: DataPath) -> object:
        if isinstance(value, dict):
            mapping = cast("Plain", value)
            for option in options(kind):
                if _is_struct(option) and _has_tag(option, mapping):
                    return self._struct(mapping, option, path)
                if get_origin(option) is dict:
                    return self._mapping(mapping, get_args(option), path)
        elif isinstance(value, list):
            items = cast("list[object]", value)
            for option in options(kind):
                kinds = _items(option, len(items))
                if kinds is not None:
                    return [self._kept(each, kinds[i], (*path, i)) for i, each in enumerate(items)]
        return _BROKEN

    def _struct(self, value: Plain, kind: type[msgspec.Struct], path: DataPath) -> Plain:
        fields = {each.encode_name: each for each in msgspec.structs.fields(kind)}
        tag = kind.__struct_config__.tag_field
        known = len(self.mistakes)
        kept: Plain = {}
        for key, each in value.items():
            if key == tag:
                kept[key] = each
            elif key not in fields:
                kept |= self._unknown(value, key, fields, path)
            elif fields[key].required:
                kept[key] = self._kept(each, fields[key].type, (*path, key))
            else:
                found = self._value(each, fields[key].type, (*path, key))
                kept |= {key: found} if found is not _BROKEN else {}
        for name, each in fields.items():
            if each.required and name not in kept:
                self._note(DocumentMistake(path=(*path, name), fault="missing"))
                kept[name] = self._stand_in(each.type)
        repair = self.repairs.get(kind)
        if repair is not None and len(self.mistakes) > known:
            kept = repair(kept)
        return kept

    def _unknown(self, value: Plain, key: str, fields: Mapping[str, FieldInfo], path: DataPath) -> Plain:
        """Read a mistyped key as the most similar valid one, if its value is valid there."""
        absent = [name for name in fields if name not in value]
        meant = next(iter(close_names(key[:_LONGEST_KEY], absent, most=1, cutoff=_ALIKE)), "")
        number = len(self.mistakes)
        self._note(DocumentMistake(path=(*path, key), fault="unknown", meant=meant))
        found = self._value(value[key], fields[meant].type, (*path, meant)) if meant else _BROKEN
        if found is _BROKEN:
            self.mistakes[number:] = [DocumentMistake(path=(*path, key), fault="unknown")]
            return {}
        return {meant: found}

    def _mapping(self, value: Plain, kinds: tuple[Any, ...], path: DataPath) -> Plain:
        key_kind, value_kind = kinds
        kept: Plain = {}
        for key, each in value.items():
            complaint = _complaint(key, key_kind)
            if complaint is not None:
                self._note(DocumentMistake(path=(*path, key), fault="key", complaint=complaint))
            found = self._kept(each, value_kind, (*path, key))
            kept |= {key: found} if complaint is None else {}
        return kept

    def _kept(self, value: object, kind: Any, path: DataPath) -> object:
        """Return the remaining data of a required value."""
        found = self._value(value, kind, path)
        return self._stand_in(kind) if found is _BROKEN else found

    def _stand_in(self, kind: Any) -> object:
        """Return a valid placeholder value; broken if none is known."""
        candidates = (self._made(option) for option in options(kind))
        return next((each for each in candidates if each is not _BROKEN and _complaint(each, kind) is None), _BROKEN)

    def _made(self, option: Any) -> object:
        if _is_struct(option):
            fields = msgspec.structs.fields(cast("type[msgspec.Struct]", option))
            made: Plain = {each.encode_name: self._stand_in(each.type) for each in fields if each.required}
            repair = self.repairs.get(cast("type", option))
            return repair(made) if repair is not None else made
        if get_origin(option) is dict:
            return {UNREADABLE: self._stand_in(get_args(option)[1])}
        if get_origin(option) is Literal:
            return get_args(option)[0]
        kinds = _items(option, 1)
        if kinds is not None:
            return [self._stand_in(kinds[0])]
        return {str: UNREADABLE, bool: False, int: 1, float: 1.0}.get(option, _BROKEN)

    def _note(self, mistake: DocumentMistake) -> None:
        self.mistakes.append(mistake)
        if len(self.mistakes) >= MAX_MISTAKES:
            raise TooManyMistakes


def with_corrected_keys(source: DocumentSource, mistakes: Iterable[DocumentMistake]) -> DocumentSource:
    """Return a document in which the values of mistyped keys are also found under the corrected keys."""
    place = source.place
    for mistake in mistakes:
        if mistake.meant:
            place = _with_alias(place, mistake.path, mistake.meant)
    return replace(source, place=place)


def _with_alias(place: PositionTree, path: DataPath, meant: str) -> PositionTree:
    children = dict(place.children or {})
    step, rest = path[0], path[1:]
    if step not in children:
        return place
    if rest:
        children[step] = _with_alias(children[step], rest, meant)
    else:
        children[meant] = children[step]
    return msgspec.structs.replace(place, children=children)


def options(kind: Any) -> Iterator[Any]:
    """Yield the types that a value may have, without their annotations."""
    origin = get_origin(kind)
    if origin is Annotated:
        yield from options(get_args(kind)[0])
    elif origin in (Union, types.UnionType):
        for option in get_args(kind):
            yield from options(option)
    else:
        yield kind


def _complaint(value: object, kind: Any) -> str | None:
    try:
        msgspec.convert(value, kind)
    except msgspec.ValidationError as error:
        return str(error)
    return None


def _is_struct(option: Any) -> bool:
    return isinstance(option, type) and issubclass(option, msgspec.Struct)


def _has_tag(kind: type[msgspec.Struct], value: Plain) -> bool:
    config = kind.__struct_config__
    return config.tag_field is None or value.get(config.tag_field) == config.tag


def _items(option: Any, count: int) -> list[Any] | None:
    """Return the types of `count` items of a list; None for other types or an invalid count."""
    arguments = get_args(option)
    if get_origin(option) is list or (get_origin(option) is tuple and arguments[-1:] == (...,)):
        return [arguments[0]] * count
    return list(arguments) if get_origin(option) is tuple and len(arguments) == count else None
