"""The strict reader: what it accepts, what it refuses and where, and how fast."""

from __future__ import annotations

import json
import os
import time
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.document.text.core_schema import plain_scalar
from engine.document.text.yaml_source import MAX_BYTES, load_source, parse_source
from engine.errors import DocumentError, Position
from tests.engine.json_values import json_values

HOSTILE: dict[str, tuple[bytes, int, int, str]] = {
    "empty file": (b"", 1, 1, "the document is empty"),
    "comments only": (b"# nothing\n", 1, 1, "the document is empty"),
    "byte order mark": (b"\xef\xbb\xbfa: 1\n", 1, 1, "byte order mark"),
    "UTF-16": ("a: 1\n".encode("utf-16"), 1, 1, "UTF-16"),
    "invalid UTF-8": (b"a: 1\nb: \xff\n", 2, 4, "byte 0xff is not UTF-8"),
    "garbage bytes": (bytes(range(256)), 2, 118, "byte 0x80 is not UTF-8"),
    "control character": (b"a: 1\nb: \x00\n", 2, 4, "U+0000 is not allowed"),
    "line separator": ("a: b\u2028c\n".encode(), 1, 5, "U+2028 is not allowed"),
    "tab as indent": (b"a:\n\tb: 1\n", 2, 1, "not a tab"),
    "alias bomb": (b"a: &a [x, x]\nb: &b [*a, *a]\n", 1, 4, "the anchor `&a`"),
    "alias alone": (b"a: *b\n", 1, 4, "the alias `*b`"),
    "merge key": (b"a: 1\n<<: {b: 2}\n", 2, 1, "merge key"),
    "python tag": (b"a: !!python/object/apply:os.system [ls]\n", 1, 4, "the tag"),
    "text tag": (b"a: !!str 1\n", 1, 4, "the tag"),
    "tag directive": (b"%TAG ! tag:x,2000:\n---\na: 1\n", 1, 1, "%TAG"),
    "YAML 1.1": (b"%YAML 1.1\n---\na: on\n", 1, 1, "this is YAML 1.1"),
    "second document": (b"a: 1\n---\nb: 2\n", 2, 1, "a second document"),
    "duplicate key": (b"a: 1\nb: 2\na: 3\n", 3, 1, "`a` is repeated; it first occurs on line 1"),
    "duplicate key by quotes": (b"{a: 1, 'a': 2}\n", 1, 8, "`a` is repeated"),
    "empty key": (b"a: 1\n~: 2\n", 2, 1, "a key is empty"),
    "no key": (b"a: 1\n: 2\n", 2, 1, "no key is here"),
    "list as key": (b"? [a]\n: 1\n", 1, 3, "a key must be text"),
    "expression without quotes": (b"a: {b: ${x}}\n", 1, 9, "unmatched brace"),
    "colon in text": (b"a: b: c\n", 1, 5, "a second `:`"),
    "open quote": (b'a: "x\n', 2, 1, "unexpected end"),
    "open bracket": (b"a: [1,\n", 2, 1, "a value is missing before this place"),
    "bracket closed by a brace": (b"a: [1, 2\nb: 3\n", 2, 2, "unmatched bracket"),
    "item out of line": (b"a:\n  - 1\n  b: 2\n", 3, 3, "where the list goes on"),
    "key without a colon": (b"a: 1\nb\nc: 2\n", 3, 1, "a `:` is missing after a key"),
    "text that begins with an at": (b"a: @b\n", 1, 4, "no value can begin with this character"),
    "huge integer": (b"a: " + b"9" * 50_000, 1, 4, "does not fit into 64 bits"),
    "just too large integer": (b"a: 9223372036854775808\n", 1, 4, "does not fit into 64 bits"),
    "huge hexadecimal": (b"a: 0x" + b"f" * 500, 1, 4, "does not fit into 64 bits"),
    "infinite float": (b"a: 1e999\n", 1, 4, "too large for a number"),
    "infinity": (b"a: -.inf\n", 1, 4, "not a finite number"),
    "not a number": (b"a: .NaN\n", 1, 4, "not a finite number"),
    "10 MB of brackets": (b"[" * 10_000_000, 1, 1, "larger than 2 MB"),
    "2 MB of brackets": (b"[" * MAX_BYTES, 1, 65, "nested deeper than 64 levels"),
    "2 MB of braces": (b"{a: " * (MAX_BYTES // 4), 1, 257, "nested deeper than 64 levels"),
    "2 MB of dashes": (b"- " * (MAX_BYTES // 2), 1, 129, "nested deeper than 64 levels"),
    "2 MB of question marks": (b"? " * (MAX_BYTES // 2), 1, 3, "a key must be text"),
    "2 MB of anchors": (b"&a " * (MAX_BYTES // 3), 1, 1, "the anchor"),
    "2 MB of colons": (b"a:" * (MAX_BYTES // 2), 1, MAX_BYTES, "a second `:`"),
    "2 MB of open quote": (b'a: "' + b"x\n" * (MAX_BYTES // 2 - 2), MAX_BYTES // 2 - 1, 1, "unexpected end"),
    "2 MB of line breaks": (b"\n" * MAX_BYTES, 1, 1, "the document is empty"),
    "20 001 expressions": (b"a: [" + b"'${a}'," * 20_001 + b"]", 1, 140_005, "more than 20000 expressions"),
    "long texts with expressions": (
        b"a: [" + (b"'${a}" + b"x" * 60_000 + b"',\n") * 2 + b"]",
        2,
        1,
        "100000 characters",
    ),
    "250 000 values": (b"[" + b"1,\n" * 250_000 + b"]", 200_000, 1, "more than 200000 values"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_text_is_refused_at_its_place_in_bounded_time(name: str) -> None:
    """One error with file, line and column, whatever comes."""
    content, line, column, says = HOSTILE[name]
    start = time.thread_time()
    with pytest.raises(DocumentError) as refusal:
        parse_source(content, file="x.yaml")
    assert time.thread_time() - start < 4.0  # 0.9 s on an idle machine; hostile text takes minutes where unbounded
    assert refusal.value.where == Position(file="x.yaml", line=line, column=column)
    assert says in refusal.value.message


def read_or_refused(content: bytes | str) -> bool:
    """Tell whether text is read, or refused with a position; other errors pass through."""
    try:
        parse_source(content, file="x.yaml")
    except DocumentError as refusal:
        return isinstance(refusal.where, Position)
    return True


@given(st.binary(max_size=200) | st.text(max_size=200))
def test_any_text_is_read_or_refused_with_a_position(content: bytes | str) -> None:
    """Nothing else than a DocumentError ever comes out."""
    assert read_or_refused(content)


@given(st.text("{}[]:,-?&*!|>'\"#%@ \n\tab1.~<", max_size=60))
def test_any_mix_of_yaml_signs_is_read_or_refused_with_a_position(text: str) -> None:
    """Signs of YAML in any order meet the same rule."""
    assert read_or_refused(text)


UNREADABLE = "\x85\u2028\u2029\ufeff\ufffe\uffff"
FLOATS = st.floats(allow_nan=False, allow_infinity=False)
JSON_TEXT = st.text(
    st.characters(exclude_categories=["Cs", "Cc"], exclude_characters="\x85\u2028\u2029\ufeff\ufffe\uffff")
)
# YAML allows a key at most 1024 characters as written, escapes included.
JSON_KEY = JSON_TEXT.map(lambda text: text[:80])
JSON_VALUES = json_values(JSON_TEXT, JSON_KEY)


@given(value=JSON_VALUES, escape=st.booleans(), indent=st.sampled_from([None, 1, 4, "\t"]), compact=st.booleans())
def test_json_files_mean_what_json_means(value: object, escape: bool, indent: int | str | None, compact: bool) -> None:
    """JSON text, spaced in any way, with any characters escaped or not, gives the same data."""
    separators = (",", ":") if compact else None
    text = json.dumps(value, ensure_ascii=escape, indent=indent, separators=separators)
    if not any(ord(c) in range(0xFDD0, 0xFDF0) for c in text):
        assert parse_source(text, file="x.json").data == value


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("no", "no"),
        ("on", "on"),
        ("yes", "yes"),
        ("12:30:45", "12:30:45"),
        ("2026-01-01", "2026-01-01"),
        ("1_000", "1_000"),
        ("1e3", 1000.0),
        ("1.", 1.0),
        (".5", 0.5),
        ("+3", 3),
        ("-0", 0),
        ("007", 7),
        ("0o17", 15),
        ("0x1F", 31),
        ("~", None),
        ("null", None),
        ("Null", None),
        ("true", True),
        ("FALSE", False),
        ("", None),
        ("9223372036854775807", 2**63 - 1),
        ("-9223372036854775808", -(2**63)),
        ("nullable", "nullable"),
        ("-", "-"),
        ("1.2.3", "1.2.3"),
        ("-x", "-x"),
        ("trUe", "trUe"),
    ],
)
def test_plain_text_follows_the_core_schema_of_yaml_12(text: str, value: object) -> None:
    """Words of YAML 1.1 stay text; numbers are numbers."""
    read = plain_scalar(text)
    assert (read, type(read)) == (value, type(value))


def test_positions_lead_to_keys_and_values() -> None:
    """Every part of a document knows its line and column; absent parts give what is around them."""
    source = parse_source("a:\n  b: [1, 2]\n  'c d': x\n", file="x.yaml")
    found = [
        source.position(path, of_key=key)
        for path, key in (
            (("a", "b"), True),
            (("a", "b", 1), False),
            (("a", "c d"), False),
            (("a", "nothing", 3), False),
            ((), False),
        )
    ]
    assert [(p.line, p.column) for p in found] == [(2, 3), (2, 10), (3, 10), (1, 1), (1, 1)]


def test_keys_are_text_whatever_they_look_like() -> None:
    """A number or a word as key is the text that was written."""
    assert parse_source("1: a\ntrue: b\n0x10: c\n", file="x.yaml").data == {"1": "a", "true": "b", "0x10": "c"}


def test_what_is_no_readable_file_is_refused(tmp_path: Path) -> None:
    """A missing file, a folder, a pipe and a name with NUL are errors at line 1, not hangs."""
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "missing.yaml", tmp_path, tmp_path / "pipe", tmp_path / "nul\0"):
        with pytest.raises(DocumentError) as refusal:
            load_source(path)
        assert refusal.value.where == Position(file=str(path), line=1, column=1)


def test_a_large_file_is_refused_without_being_read_whole(tmp_path: Path) -> None:
    """A sparse file of 1 GB costs nothing."""
    file = tmp_path / "large.yaml"
    with file.open("wb") as stream:
        stream.truncate(1_000_000_000)
    start = time.thread_time()
    with pytest.raises(DocumentError, match="larger than 2 MB"):
        load_source(file)
    assert time.thread_time() - start < 0.5


@pytest.mark.parametrize(
    "character", "\t\n\r ~\xa0\u2027\u202a\ud7ff\ue000\ufefe\uff00\ufffd\U00010000\U0010ffff", ids=ascii
)
def test_a_character_that_people_write_may_stand_in_a_document(character: str) -> None:
    parse_source(f'a: "{character}"\n', file="x.yaml")


@pytest.mark.parametrize(
    "character", "\x00\x08\x0b\x0c\x0e\x1f\x7f\x85\x9f\u2028\u2029\ud800\udfff\ufeff\ufffe\uffff", ids=ascii
)
def test_a_character_that_nobody_sees_may_not(character: str) -> None:
    with pytest.raises(DocumentError, match=rf"U\+{ord(character):04X} is not allowed"):
        parse_source(f'a: "{character}"\n', file="x.yaml")
