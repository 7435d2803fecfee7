"""One fact, one class: no class of the server repeats a class of the engine, no TypeScript repeats a generated type.

Two classes are compared by the names of their fields alone: a copy under another name, with other types or with other
defaults, is still a copy that somebody must keep up to date. Fields that are inherited are not repeated.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path

import msgspec
from pydantic import BaseModel

from editor_web.schema import TYPES
from tests.house.class_fields import field_names, own_fields, public_classes

ENGINE = ("engine",)
LEAST_FIELDS = 3
"""Classes with fewer fields share names by chance."""
MOST_SHARED = 0.75
SOURCES = TYPES.parent.parent
NOT_MIRRORS: Mapping[str, str] = {
    "TagsBody": "a change of tags; a row of the store has the key of the entry too",
    "TaughtReference": "names an entry or a capture; a row of the store has the key of the entry too",
    "TimelineMarker": "a mark on the timeline for many kinds of events",
    "UserdataBody": "a value that a person reads or sets; the event of a write has its writer, number and time",
}
"""Classes of the server that share names with a class of the engine, and why they are not that class."""
NOT_REPEATED: Mapping[str, str] = {
    "api/preview.ts Previewed": "an entry that a form shows; the message to the server also has its revision",
    "api/refusal.ts Refusal": "what any command was refused with, in words",
    "document/busTree.ts Named": "what topics and skills have in common",
    "document/demonstration.ts Step": "a step that a person orders, with a key of its own",
    "document/editing/changes.ts ChangeWords": "a change in words",
    "document/timeline.ts LoadedTimeline": "a timeline that grows, with its rows by path",
    "document/timelineMoment.ts ShownMoment": "a moment with the run that it is of",
}
"""Interfaces of the page that share names with a generated one, and why they are not that one."""
_INTERFACE = re.compile(r"^(?:export )?interface (\w+)[^{]*\{\n(.*?)^\}", re.MULTILINE | re.DOTALL)
_FIELD = re.compile(r"^  readonly (\w+)\??:", re.MULTILINE)


def test_no_class_of_the_server_repeats_a_class_of_the_engine() -> None:
    """But those that are named above, all of which are needed."""
    ours = public_classes("editor_web")
    assert len(ours) > 50, "the classes of the server are not found any more"
    theirs = {name: field_names(each) for name, each in public_classes("engine").items()}
    found = _mirrors({name: own_fields(each, packages=ENGINE) for name, each in ours.items()}, theirs)
    named = {name.rsplit(".", 1)[-1]: words for name, words in found.items()}
    assert named == {name: named.get(name, "no mirror: take its exception away") for name in NOT_MIRRORS}


def test_no_interface_of_the_page_repeats_a_generated_one() -> None:
    """Whatever crosses is imported from `api/types.ts`."""
    generated = dict(_interfaces(TYPES))
    assert len(generated) > 100, "the generated types are not found any more"
    written = {
        f"{file.relative_to(SOURCES)} {name}": names
        for folder in ("api", "document")
        for file in sorted((SOURCES / folder).rglob("*.ts"))
        if file != TYPES
        for name, names in _interfaces(file)
    }
    found = _mirrors(written, generated)
    assert found == {name: found.get(name, "no repetition: take its exception away") for name in NOT_REPEATED}


def test_a_mirror_of_each_kind_is_recognised() -> None:
    class Fact(msgspec.Struct):
        path: str
        line: int
        message: str
        hint: str

    class FactBody(BaseModel):
        path: str
        line: int
        message: str

    class FactLike(msgspec.Struct):
        path: str
        line: int
        message: str
        seen: bool

    class SeenFact(Fact):
        seen: bool

    class Other(msgspec.Struct):
        path: str
        line: int
        seen: bool

    ours = {
        cls.__name__: own_fields(cls, packages=ENGINE, apart_from=(Fact,))
        for cls in (FactBody, FactLike, SeenFact, Other)
    }
    assert list(_mirrors(ours, {"Fact": field_names(Fact)})) == ["FactBody", "FactLike"]


def _mirrors(ours: Mapping[str, frozenset[str]], theirs: Mapping[str, frozenset[str]]) -> dict[str, str]:
    """Return what each of our classes repeats that has most of the fields of one of theirs."""
    found: dict[str, str] = {}
    for name, names in ours.items():
        if len(names) < LEAST_FIELDS:
            continue
        share, nearest = max((len(names & other) / len(names), there) for there, other in theirs.items())
        if share >= MOST_SHARED:
            found[name] = f"{share:.0%} of its {len(names)} fields are those of {nearest}"
    return found


def _interfaces(file: Path) -> Iterator[tuple[str, frozenset[str]]]:
    for match in _INTERFACE.finditer(file.read_text(encoding="utf-8")):
        yield match[1], frozenset(_FIELD.findall(match[2]))
