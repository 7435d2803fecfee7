"""Decodes plain data to typed models; mismatches are reported with line and column."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import TypeVar, cast

import msgspec
from msgspec import inspect

from engine.document.text.mistakes import DocumentMistake, MistakeCollector, with_corrected_keys
from engine.document.text.yaml_source import DataPath, DocumentSource
from engine.errors import DocumentError
from engine.wording.misfit import Misfit, declared_in, in_words, suggested_choices, types_at
from engine.wording.suggestions import did_you_mean

T = TypeVar("T")

_MISSING = re.compile(r"Object missing required field `(.*)`")


class StrictModel(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, omit_defaults=True):
    """Base class of document models: unknown keys are errors."""


def decode_document(source: DocumentSource, kind: type[T], *, refused: Mapping[str, str] | None = None) -> T:
    """Return the document as a `kind`.

    Args:
        source: The parsed document.
        kind: A model, usually a `StrictModel` one.
        refused: Hints for known but unsupported keys.

    Raises:
        DocumentError: the data is invalid; `where` is the position of the first mistake, `others` are the others.
    """
    try:
        return msgspec.convert(source.data, kind)
    except msgspec.ValidationError as complaint:
        collector = MistakeCollector()
        collector.sift(source.data, kind)
        found = mistake_errors(source, kind, collector.mistakes, refused=refused) or [
            _refusal(source, kind, (), str(complaint))
        ]
        raise combine_mistakes(found) from None


def combine_mistakes(mistakes: Sequence[DocumentError]) -> DocumentError:
    """Return the first mistake of a document, with the others as its `others`."""
    first, *others = mistakes
    first.others = tuple(others)
    return first


def mistake_errors(
    source: DocumentSource,
    kind: object,
    mistakes: Iterable[DocumentMistake],
    *,
    refused: Mapping[str, str] | None = None,
) -> list[DocumentError]:
    """Return the errors of a document of type `kind`."""
    known = list(mistakes)
    corrected = with_corrected_keys(source, known)
    return [_of_mistake(corrected, kind, mistake, refused or {}) for mistake in known]


def _of_mistake(
    source: DocumentSource, kind: object, mistake: DocumentMistake, refused: Mapping[str, str]
) -> DocumentError:
    path = mistake.path
    match mistake.fault:
        case "unknown":
            name = str(path[-1])
            where = source.position(path, of_key=True)
            if name in refused:
                return DocumentError(f"this version does not support `{name}`", where=where, hint=refused[name])
            hint = did_you_mean(name, field_names(kind, path[:-1]))
            return DocumentError(f"unknown key `{name}`", where=where, hint=hint)
        case "missing":
            return DocumentError(f"the key `{path[-1]}` is missing", where=source.position(path[:-1], of_key=True))
        case "key":
            return _refusal(source, kind, path, mistake.complaint, of_key=True)
        case "value":
            return _refusal(source, kind, path, mistake.complaint)


def _refusal(
    source: DocumentSource, kind: object, path: DataPath, complaint: str, *, of_key: bool = False
) -> DocumentError:
    misfit = Misfit.of(complaint)
    path = (*path, *misfit.path)
    missing = _MISSING.fullmatch(misfit.what)
    if missing:
        return DocumentError(f"the key `{missing[1]}` is missing", where=source.position(path, of_key=True))
    where = source.position(path, of_key=of_key)
    name = next((step for step in reversed(path) if isinstance(step, str)), None)
    subject = f"`{name}`: " if name is not None else ""
    hint = _advice(kind, path, of_key=of_key, refused=misfit.refused_choice)
    return DocumentError(f"{subject}{in_words(misfit.what)}", where=where, hint=hint)


def field_names(kind: object, path: DataPath) -> tuple[str, ...]:
    """Return the keys that a mapping at `path` of a document of this kind may have."""
    return tuple(name for struct in _structs_at(kind, path) for name in (f.encode_name for f in struct.fields))


def _advice(kind: object, path: DataPath, *, of_key: bool, refused: str | None) -> str | None:
    """Return the hint of the model for the value (or the key) at `path`: the choices, or its description."""
    if of_key:
        mappings = [option for option in types_at(kind, path[:-1]) if isinstance(option, inspect.DictType)]
        return next((found for option in mappings if (found := _description([option.key_type]))), None)
    return suggested_choices(kind, path, refused) or _description(_declared_at(kind, path))


def _declared_at(kind: object, path: DataPath) -> list[inspect.Type]:
    """Return the types declared at `path`, with their annotations."""
    if not path:
        return []
    declared = declared_in(types_at(kind, path[:-1]), path[-1])
    return [t for found in declared for t in (found.types if isinstance(found, inspect.UnionType) else (found,))]


def _description(options: Iterable[inspect.Type]) -> str | None:
    for option in options:
        if isinstance(option, inspect.Metadata):
            extra = cast("Mapping[str, object] | None", option.extra_json_schema)  # pyright: ignore[reportUnknownMemberType]
            return str(extra["description"]) if extra and "description" in extra else None
    return None


def _structs_at(kind: object, path: DataPath) -> list[inspect.StructType]:
    return [option for option in types_at(kind, path) if isinstance(option, inspect.StructType)]
