"""Fixes of userdata: keys that a state does not have, and undefined keys."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from engine.document.signature import KeySignature
from engine.editing.edits.edit import SetDocument, SetField
from engine.editing.fixes.fix import Fix, FixContext, is_typo, mapping, similar_names, with_renamed_key, without_key

_BEGINNINGS: Mapping[str, object] = {"number": 0, "integer": 0, "string": "", "boolean": False, "array": []}


def unknown_input(place: FixContext) -> Iterator[Fix]:
    """Map the intended input, or remove the mapping."""
    yield from _remapped(place, "in", _keys(place, "inputs"))


def unknown_output(place: FixContext) -> Iterator[Fix]:
    """Map the intended output, or remove the mapping."""
    yield from _remapped(place, "out", _keys(place, "outputs"))


def _remapped(place: FixContext, section: str, known: Iterable[str]) -> Iterator[Fix]:
    if len(place.names) < 2:
        return
    name, given, names = place.names[1], place.section(section), tuple(known)
    for right in similar_names(name, names):
        if right not in given:
            edit = SetField(path=place.ref.path, field=section, value=with_renamed_key(given, name, right))
            title = f"Write `{right}` instead of `{name}`"
            yield Fix(title=title, edits=(edit,), sure=is_typo(name, right, names))
    edit = SetField(path=place.ref.path, field=section, value=without_key(given, name))
    yield Fix(title=f"Remove `{name}` from `{section}`", edits=(edit,))


def undefined(place: FixContext) -> Iterator[Fix]:
    """Read a defined key instead, or give the key an initial value."""
    key = next((name for name in place.names if name in _read_keys(place)), None)
    if key is None:
        return
    given = place.section("in")
    mapped = next((name for name, of in given.items() if of == key), key)
    defined = _defined(place)
    for right in similar_names(key, defined):
        if right != key:
            edit = SetField(path=place.ref.path, field="in", value={**given, mapped: right})
            title = f"Read `{right}` instead of `{key}`"
            yield Fix(title=title, edits=(edit,), sure=key in given.values() and is_typo(key, right, defined))
    yield from _declared(place, key, mapped)


def maybe_undefined(place: FixContext) -> Iterator[Fix]:
    """Give a key an initial value, so that it is defined on every path."""
    key = next((name for name in place.names if name in _read_keys(place)), None)
    if key is not None:
        mapped = next((name for name, of in place.section("in").items() if of == key), key)
        yield from _declared(place, key, mapped)


def _declared(place: FixContext, key: str, mapped: str) -> Iterator[Fix]:
    """Offer an initial value if the type of the key is known; a person must decide the value."""
    signature = _keys(place, "inputs").get(mapped)
    kind = signature.schema.get("type") if signature is not None else None
    if not isinstance(kind, str) or kind not in _BEGINNINGS:
        return
    value = _BEGINNINGS[kind]
    declared = mapping(place.session.draft.data.get("userdata"))
    if key not in declared:
        shown = str(value).lower() if isinstance(value, bool) else repr(value) if value == "" else str(value)
        edit = SetDocument(changes={"userdata": {**declared, key: value}})
        yield Fix(title=f"Give `{key}` the initial value {shown}", edits=(edit,))


def _keys(place: FixContext, which: str) -> Mapping[str, KeySignature]:
    state = place.ref.data.get("state")
    signature = place.session.context.signature(state) if isinstance(state, str) else None
    if signature is None:
        return {}
    return signature.inputs if which == "inputs" else signature.outputs


def _read_keys(place: FixContext) -> set[str]:
    mapped = place.section("in")
    own = {str(mapped.get(name, name)) for name in _keys(place, "inputs")}
    return {*own, *(str(each) for each in mapped.values())}


def _defined(place: FixContext) -> set[str]:
    """All keys that are declared or written anywhere in the behavior."""
    data = place.session.draft.data
    names = {*mapping(data.get("parameters")), *mapping(data.get("userdata"))}
    for ref in place.session.outline.refs.values():
        names |= {*mapping(ref.body.get("userdata"))}
        names |= {str(each) for each in mapping(ref.data.get("out")).values()}
    return names
