"""Matches each entry of changed data to its original entry in the text."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import cast

from engine.editing.text.syntax import Collection, Member, Scalar

EntryMatch = tuple[str | None, object, Member | None]
"""A key (None in a list), its value, and the original entry in the text, if any."""


def match_entries(
    source: Collection, value: dict[str, object] | list[object], sources: Mapping[int, Collection]
) -> list[EntryMatch]:
    """Return the entries of `value` in order, each with its original entry in `source`.

    Collections match by identity, under any key; other entries match by key or, in a list, by
    value, then by position.
    """
    if isinstance(value, dict):
        return _entries(source, value, sources)
    return _items(source, value, sources)


def is_same_value(a: object, b: object) -> bool:
    """Return whether two scalars are equal in value and type: 1 is not 1.0 and not true."""
    return type(a) is type(b) and a == b


def is_equal_data(a: object, b: object) -> bool:
    """Return whether two values are equal in type and order."""
    if isinstance(a, dict) and isinstance(b, dict):
        one, two = cast("dict[str, object]", a), cast("dict[str, object]", b)
        return list(one) == list(two) and all(is_equal_data(each, two[key]) for key, each in one.items())
    if isinstance(a, list) and isinstance(b, list):
        many, more = cast("list[object]", a), cast("list[object]", b)
        return len(many) == len(more) and all(is_equal_data(one, other) for one, other in zip(many, more, strict=True))
    return is_same_value(cast("object", a), b)


def _entries(source: Collection, value: dict[str, object], sources: Mapping[int, Collection]) -> list[EntryMatch]:
    entries, members = list(value.items()), source.members
    # Nearly all entries are where they were: only those between the first and the last one that is not are matched.
    head = _count_same(zip(members, entries, strict=False), sources)
    many, more = members[head:], entries[head:]
    tail = _count_same(zip(reversed(many), reversed(more), strict=False), sources)
    middle = _matched(many[: len(many) - tail], dict(more[: len(more) - tail]), value, sources)
    first, last = (
        zip(members[:head], entries[:head], strict=True),
        zip(many[::-1][:tail], more[::-1][:tail], strict=True),
    )
    return [
        *((key, each, member) for member, (key, each) in first),
        *middle,
        *((key, each, member) for member, (key, each) in reversed(list(last))),
    ]


def _count_same(pairs: Iterable[tuple[Member, tuple[str, object]]], sources: Mapping[int, Collection]) -> int:
    """Count the first entries that are the same collections under the same keys."""
    count = 0
    for member, (key, each) in pairs:
        own = member.value
        if _key(member) != key or not isinstance(own, Collection) or own.data is not each:
            break
        if sources.get(id(each)) is not own:
            break
        count += 1
    return count


def _matched(
    those: list[Member], value: dict[str, object], whole: dict[str, object], sources: Mapping[int, Collection]
) -> list[EntryMatch]:
    """Match some entries of a mapping; `whole` are all of them."""
    members = {str(member.key.value): member for member in those if member.key is not None}
    by_value = {id(member.value): member for member in those}
    found: dict[str, Member] = {}
    taken: set[int] = set()
    for key, each in value.items():
        own = by_value.get(id(sources.get(id(each))))
        if own is not None and members.get(key) is own:
            found[key] = own
            taken.add(id(own))
    for key, each in value.items():
        own = by_value.get(id(sources.get(id(each))))
        if key not in found and own is not None and id(own) not in taken and str(_key(own)) not in whole:
            found[key] = own
            taken.add(id(own))
    for key in value:
        own = members.get(key)
        if key not in found and own is not None and id(own) not in taken:
            found[key] = own
            taken.add(id(own))
    left = [member for member in those if id(member) not in taken and str(_key(member)) not in whole]
    fresh = [key for key in value if key not in found]
    if len(left) == len(fresh):
        # Keys of which only the name has changed.
        found |= {key: own for key, own in zip(fresh, left, strict=True) if _says(own, value[key])}
    is_one = len(left) == len(fresh) == 1 and isinstance(left[0].value, Scalar)
    if is_one and those.index(left[0]) == list(value).index(fresh[0]):
        # One entry in the place of another: the comments beside it are about both. A collection takes its own along.
        found[fresh[0]] = left[0]
    return [(key, each, found.get(key)) for key, each in value.items()]


def _items(source: Collection, value: list[object], sources: Mapping[int, Collection]) -> list[EntryMatch]:
    found: dict[int, Member] = {}
    left = list(enumerate(source.members))

    def is_same(member: Member, each: object) -> bool:
        return sources.get(id(each)) is member.value or (not isinstance(each, dict | list) and _says(member, each))

    def take(number: int, place: int) -> None:
        found[number] = source.members[place]
        left.remove((place, source.members[place]))

    short = min(len(value), len(source.members))
    head = next((n for n in range(short) if not is_same(source.members[n], value[n])), short)
    tail = next((n for n in range(short - head) if not is_same(source.members[-1 - n], value[-1 - n])), short - head)
    for number in range(head):
        take(number, number)
    for number in range(tail):
        take(len(value) - 1 - number, len(source.members) - 1 - number)
    for number, each in enumerate(value):
        place = next((place for place, member in left if is_same(member, each)), None)
        if number not in found and place is not None:
            take(number, place)
    for number, each in enumerate(value):
        place = next((place for place, member in left if place == number and isinstance(member.value, Scalar)), None)
        if number not in found and place is not None and not isinstance(each, dict | list):
            take(number, place)
    return [(None, each, found.get(number)) for number, each in enumerate(value)]


def _key(member: Member) -> object:
    return member.key.value if member.key is not None else None


def _says(member: Member, value: object) -> bool:
    return isinstance(member.value, Scalar) and is_same_value(member.value.value, value)


def graft(old: object, new: object) -> object:
    """Return `new` built from the dicts and lists of `old` where they correspond, so that their text is kept."""
    if isinstance(old, dict) and isinstance(new, dict):
        kept = cast("dict[str, object]", old)
        made = {
            key: graft(kept[key], each) if key in kept else each for key, each in cast("dict[str, object]", new).items()
        }
        kept.clear()
        kept.update(made)
        return kept
    if isinstance(old, list) and isinstance(new, list):
        before, after = cast("list[object]", old), cast("list[object]", new)
        before[:] = _grafted(list(before), after)
        return before
    return new


def _grafted(old: list[object], new: list[object]) -> list[object]:
    left = list(old)
    made: list[object] = [None] * len(new)
    due: list[int] = []
    for number, each in enumerate(new):
        place = next((i for i, was in enumerate(left) if was == each), None)
        if place is None:
            due.append(number)
        else:
            made[number] = graft(left.pop(place), each)
    for number in due:
        # Of the entries whose value changed, the first one of the same type.
        place = next((i for i, was in enumerate(left) if type(was) is type(new[number])), None)
        made[number] = new[number] if place is None else graft(left.pop(place), new[number])
    return made
