"""Factors as they are written on the command line: `speed=0.3..1.0`, `displace.bolt.x_m=normal(0, 0.004)`."""

from __future__ import annotations

import re

import msgspec

from engine.errors import DocumentError

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_RANGE = re.compile(rf"({_NUMBER})\.\.({_NUMBER})")
_LOG = re.compile(rf"log\(\s*({_NUMBER})\.\.({_NUMBER})\s*\)")
_NORMAL = re.compile(rf"normal\(\s*({_NUMBER})\s*,\s*({_NUMBER})\s*\)")
_KINDS = ("seed", "faults", "substitutes")
_FORMS = "NAME=0.3..1.0, NAME=1,2,5, NAME=log(0.01..10) or NAME=normal(0, 0.004)"


def parse_factor(text: str) -> tuple[str, dict[str, object]]:
    """Return the address and the document of a factor; a name without a dot is a parameter.

    Raises:
        DocumentError: the text is none of the forms.
    """
    name, equals, values = text.partition("=")
    name = name.strip()
    if not equals or not name or not values.strip():
        raise DocumentError(f"{text!r} is not a factor", where="--vary", hint=_FORMS)
    address = name if "." in name or name in _KINDS else f"parameters.{name}"
    return address, _distribution(values.strip())


def _distribution(text: str) -> dict[str, object]:
    if (found := _RANGE.fullmatch(text)) is not None:
        whole = "." not in found[1] + found[2] and "e" not in (found[1] + found[2]).lower()
        limits = [float(found[1]), float(found[2])]
        return {"uniform": limits, "integer": True} if whole else {"uniform": limits}
    if (found := _LOG.fullmatch(text)) is not None:
        return {"log_uniform": [float(found[1]), float(found[2])]}
    if (found := _NORMAL.fullmatch(text)) is not None:
        return {"normal": {"mean": float(found[1]), "deviation": float(found[2])}}
    return {"values": [_value(each) for each in text.split(",")]}


def _value(text: str) -> object:
    """Return a JSON value, or the text itself where it is none."""
    try:
        return msgspec.json.decode(text.strip())
    except msgspec.DecodeError:
        return text.strip()
