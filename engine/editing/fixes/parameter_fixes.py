"""Fixes of parameters of a state or behavior: unknown names, missing values, values out of range."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import cast

from engine.document.text.yaml_source import load_source
from engine.editing.edits.edit import AnyEdit, ClearParameter, SetDocument, SetField, SetParameter
from engine.editing.fixes.fix import Fix, FixContext, is_typo, mapping, similar_names
from engine.editing.text.outline import Plain
from engine.errors import DocumentError

_PLAIN = ("number", "integer", "string", "boolean")


def unknown_state(place: FixContext) -> Iterator[Fix]:
    """Replace an unknown state with an existing one."""
    wrong, known = place.names[0], place.session.context.catalogue
    for right in similar_names(wrong, known):
        edit = SetField(path=place.ref.path, field="state", value=right)
        yield Fix(title=f"Run `{right}`", edits=(edit,), sure=is_typo(wrong, right, known))


def unknown(place: FixContext) -> Iterator[Fix]:
    """Move the value to the intended parameter, or remove it."""
    if len(place.names) < 2:
        return
    name, given = place.names[1], place.section("with")
    clear = ClearParameter(path=place.ref.path, name=name)
    known = schemas_of(place)
    for right in similar_names(name, known):
        if right not in given:
            put = SetParameter(path=place.ref.path, name=right, value=given.get(name))
            yield Fix(title=f"Rename it to `{right}`", edits=(clear, put), sure=is_typo(name, right, known))
    yield Fix(title=f"Remove `{name}`", edits=(clear,))


def missing(place: FixContext) -> Iterator[Fix]:
    """Bind a parameter to one of the behavior, declare one for it, or set it to a valid value."""
    if len(place.names) < 2:
        return
    name = place.names[1]
    schema = schemas_of(place).get(name, {})
    declared = mapping(place.session.draft.data.get("parameters"))
    if name in declared:
        yield replace(_given(place, name, f"${{{name}}}"), sure=True)
    else:
        yield from _handed_on(place, name, schema, declared)
    for value in _likely(schema):
        yield _given(place, name, value)


def _given(place: FixContext, name: str, value: object) -> Fix:
    edit = SetParameter(path=place.ref.path, name=name, value=value)
    return Fix(title=f"Insert `{name}: {_shown(value)}`", edits=(edit,))


def _shown(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else f"{value:g}" if isinstance(value, float) else str(value)


def _handed_on(place: FixContext, name: str, schema: Mapping[str, object], declared: Plain) -> Iterator[Fix]:
    if schema.get("type") not in _PLAIN:
        return
    kept = ("type", "minimum", "maximum", "unit", "description")
    made: Plain = {key: schema[key] for key in kept if key in schema}
    if isinstance(schema.get("enum"), list):
        made["choices"] = schema["enum"]
    edits: tuple[AnyEdit, ...] = (
        SetDocument(changes={"parameters": {**declared, name: made}}),
        SetParameter(path=place.ref.path, name=name, value=f"${{{name}}}"),
    )
    yield Fix(title=f"Make `{name}` a parameter of the behavior", edits=edits)


def _likely(schema: Mapping[str, object]) -> list[object]:
    """Return values that are certainly valid: the choices, true and false, the number closest to zero."""
    choices = schema.get("enum")
    if isinstance(choices, list):
        return list(cast("list[object]", choices))[:3]
    if schema.get("type") == "boolean":
        return [True, False]
    if schema.get("type") in ("number", "integer"):
        if "exclusiveMinimum" in schema or "exclusiveMaximum" in schema:
            return []
        low, high = schema.get("minimum"), schema.get("maximum")
        value = 0
        value = max(value, low) if isinstance(low, int | float) else value
        return [min(value, high) if isinstance(high, int | float) else value]
    return []


def bad(place: FixContext) -> Iterator[Fix]:
    """Set a number to the limit that it exceeds, a choice to the intended one, or a value to the default."""
    name = place.names[0] if place.names else ""
    given = place.section("with")
    schema = schemas_of(place).get(name)
    if schema is None or name not in given:
        return
    value = given[name]
    path = place.ref.path
    low, high = schema.get("minimum"), schema.get("maximum")
    if isinstance(value, int | float) and not isinstance(value, bool):
        for limit, sign in ((low, 1), (high, -1)):
            if isinstance(limit, int | float) and sign * value < sign * limit:
                edit = SetParameter(path=path, name=name, value=limit)
                yield Fix(title=f"Set `{name}` to its limit {_shown(float(limit))}", edits=(edit,))
    choices = schema.get("enum")
    if isinstance(value, str) and isinstance(choices, list):
        known = [each for each in cast("list[object]", choices) if isinstance(each, str)]
        for right in similar_names(value, known) or known[:3]:
            edit = SetParameter(path=path, name=name, value=right)
            yield Fix(title=f"Set `{name}` to `{right}`", edits=(edit,), sure=is_typo(value, right, known))
    if "default" in schema:
        yield Fix(title=f"Reset `{name}` to its default", edits=(ClearParameter(path=path, name=name),))


def schemas_of(place: FixContext) -> dict[str, Mapping[str, object]]:
    """Return the JSON Schema of each parameter that the node takes; of a behavior as it declares them."""
    data, context = place.ref.data, place.session.context
    if isinstance(data.get("state"), str):
        signature = context.signature(str(data["state"]))
        if signature is None:
            return {}
        return {
            name: each.schema if each.required else {"default": None, **each.schema}
            for name, each in signature.parameters.items()
        }
    file = context.file_of(str(data["behavior"])) if isinstance(data.get("behavior"), str) else None
    try:
        document = mapping(load_source(file).data) if file is not None else {}
    except DocumentError:
        return {}
    return {name: _of_declared(mapping(each)) for name, each in mapping(document.get("parameters")).items()}


def _of_declared(parameter: Plain) -> Mapping[str, object]:
    kept = {key: value for key, value in parameter.items() if key != "choices"}
    return {**kept, "enum": parameter["choices"]} if parameter.get("choices") else kept
