"""Renders plain data as readable YAML or JSON: quotes only where needed, short values on one line."""

from __future__ import annotations

import json
import re
from typing import Any, cast

import yaml
from yaml.resolver import Resolver

from engine.document.text.core_schema import plain_scalar

_PLAIN = re.compile(r"[\w./](?:[^\n:#,\[\]{}\"'`|>&*!%@?\\]|:(?=[^\s,\[\]{}])|(?<=\S)#)*", re.ASCII)
_PLAIN_IN_BLOCK = re.compile(r"[\w./](?:[^\n:#\"`]|:(?=\S)|(?<=\S)#)*")
_PLAIN_KEY = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_./-]{0,250}")
_LITERAL = re.compile(r"(?!\s)(?:[^\n]*\S\n+)*[^\n]*\S\n?")
_HIDDEN = re.compile("[\x7f-\xa0\u2028\u2029\ud800-\udfff\ufeff\ufffe\uffff\u200b-\u200f\u202a-\u202e\u2066-\u2069]")
_TEXT = "tag:yaml.org,2002:str"
_resolver = Resolver()


def is_plain(text: str, *, flow: bool) -> bool:
    """Return whether text can be written without quotes and is the same text in YAML 1.1 and 1.2."""
    pattern = _PLAIN if flow else _PLAIN_IN_BLOCK
    return (
        pattern.fullmatch(text) is not None
        and text.isprintable()
        and not text.endswith((" ", ":"))
        and "${" not in text
        and is_text(text)
    )


def is_text(text: str) -> bool:
    """Return whether both YAML versions read it as text without quotes."""
    try:
        same = plain_scalar(text) == text and isinstance(plain_scalar(text), str)
    except ValueError:
        return False
    resolve = cast("Any", _resolver.resolve)  # pyright: ignore[reportUnknownMemberType]
    return same and resolve(yaml.ScalarNode, text, (True, False)) == _TEXT


def quoted(text: str) -> str:
    """Return text in double quotes, which YAML and JSON read alike."""
    shown = json.dumps(text, ensure_ascii=False)
    return _HIDDEN.sub(lambda found: f"\\u{ord(found.group()):04x}", shown)


def key_text(key: str, *, json: bool) -> str:
    """Return a key of a mapping."""
    return key if not json and _PLAIN_KEY.fullmatch(key) and is_text(key) else quoted(key)


def scalar_text(value: object, *, json: bool, flow: bool, style: str = "") -> str:
    """Return a scalar on one line; text keeps the quotes of `style` if possible."""
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        shown = repr(value)
        mantissa, mark, exponent = shown.partition("e")
        return f"{mantissa}.0{mark}{exponent}" if mark and "." not in mantissa else shown
    text = str(value)
    if json or style == '"':
        return quoted(text)
    if style == "'" and text.isprintable():
        return "'" + text.replace("'", "''") + "'"
    return text if is_plain(text, flow=flow) else quoted(text)


def literal_text(text: str, indent: int) -> str | None:
    """Return text of several lines as a literal block; None if that is not possible."""
    lines = text.split("\n")
    if len(lines) < 2 or not _LITERAL.fullmatch(text) or not all(line.isprintable() for line in lines):
        return None
    mark = "|" if text.endswith("\n") else "|-"
    shown = [(" " * indent + line) if line else "" for line in lines[: -1 if text.endswith("\n") else None]]
    return "\n".join([mark, *shown])


def flow_text(value: object, *, json: bool) -> str:
    """Return any value on one line."""
    if isinstance(value, dict):
        entries = cast("dict[str, object]", value).items()
        inside = [f"{key_text(key, json=json)}: {flow_text(item, json=json)}" for key, item in entries]
        return "{" + ", ".join(inside) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(flow_text(item, json=json) for item in cast("list[object]", value)) + "]"
    return scalar_text(value, json=json, flow=True)
