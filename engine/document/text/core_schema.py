"""Unquoted scalars of the YAML 1.2 core schema, limited to 64 bits and finite numbers."""

from __future__ import annotations

import math
import re

_INT = re.compile(r"[-+]?[0-9]+")
_FLOAT = re.compile(r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?")
_BASED = re.compile(r"0o[0-7]+|0x[0-9a-fA-F]+")
_NOT_FINITE = re.compile(r"[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN)")
_WORDS: dict[str, bool | None] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
}


def plain_scalar(text: str) -> bool | int | float | str | None:
    """Return the value of unquoted text in the core schema of YAML 1.2.

    Raises:
        ValueError: the number is not finite or does not fit into 64 bits.
    """
    first = text[:1]
    if first in "~nNtTfF":
        return _WORDS.get(text, text)
    if first not in "+-.0123456789":
        return text
    if _INT.fullmatch(text):
        return _integer(text, 10)
    if _FLOAT.fullmatch(text):
        number = float(text)
        if not math.isfinite(number):
            raise ValueError(f"{shorten_scalar(text)} is too large for a number")
        return number
    if _BASED.fullmatch(text):
        return _integer(text[2:], 8 if text[1] == "o" else 16)
    if _NOT_FINITE.fullmatch(text):
        raise ValueError(f"{text} is not a finite number")
    return text


def _integer(digits: str, base: int) -> int:
    # 24 characters hold any signed 64-bit number in octal; longer text is not converted.
    number = int(digits, base) if len(digits) <= 24 else None
    if number is None or not -(2**63) <= number < 2**63:
        raise ValueError(f"{shorten_scalar(digits)} does not fit into 64 bits")
    return number


def shorten_scalar(text: str) -> str:
    """Return text shortened for a message."""
    return text if len(text) <= 40 else f"{text[:37]}…"
