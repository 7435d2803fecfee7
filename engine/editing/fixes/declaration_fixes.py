"""Fixes of the declarations of a behavior."""

from __future__ import annotations

from collections.abc import Iterator

from engine.editing.edits.edit import SetDocument
from engine.editing.fixes.fix import Fix, FixContext, is_typo, mapping, similar_names, strings, without_key


def unused_parameter(place: FixContext) -> Iterator[Fix]:
    """Remove a parameter that is never read."""
    name = place.names[0]
    declared = mapping(place.session.draft.data.get("parameters"))
    if name in declared:
        edit = SetDocument(changes={"parameters": without_key(declared, name)})
        yield Fix(title=f"Remove the parameter `{name}`", edits=(edit,))


def unknown_success(place: FixContext) -> Iterator[Fix]:
    """Replace an undeclared outcome with a declared one, or remove it."""
    wrong = place.names[1] if len(place.names) > 1 else ""
    data = place.session.draft.data
    outcomes, good = strings(data.get("outcomes")), strings(data.get("success"))
    if wrong not in good:
        return
    for right in similar_names(wrong, outcomes):
        if right not in good:
            changed = [right if each == wrong else each for each in good]
            edit = SetDocument(changes={"success": changed})
            title = f"Write `{right}` instead of `{wrong}`"
            yield Fix(title=title, edits=(edit,), sure=is_typo(wrong, right, outcomes))
    rest = [each for each in good if each != wrong]
    yield Fix(title=f"Remove `{wrong}` from `success`", edits=(SetDocument(changes={"success": rest or None}),))
    edit = SetDocument(changes={"outcomes": [*outcomes, wrong]})
    yield Fix(title=f"Make `{wrong}` an outcome of the behavior", edits=(edit,))
