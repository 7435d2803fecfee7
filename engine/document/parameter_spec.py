"""Parameters of a behavior: names, types and limits of the values of a run."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

import msgspec
from msgspec import UNSET, Meta

from engine.document.text.decoding import StrictModel
from engine.errors import DocumentError
from engine.messages import Pose
from engine.wording.suggestions import did_you_mean

ParameterType = Literal["number", "integer", "string", "boolean", "pose", "joints", "list", "mapping"]

_KINDS: Mapping[str, object] = {
    "number": float,
    "integer": int,
    "string": str,
    "boolean": bool,
    "pose": Pose,
    "joints": tuple[float, ...],
    "list": list[object],
    "mapping": dict[str, object],
}
_WORDS: Mapping[str, str] = {
    "number": "a number",
    "integer": "an integer",
    "string": "text",
    "boolean": "true or false",
    "pose": "a pose {xyz: [x, y, z], xyzw: [x, y, z, w], frame: NAME}",
    "joints": "a list of joint angles in radians",
    "list": "a list",
    "mapping": "a mapping",
}


class ParameterSpec(StrictModel, frozen=True, kw_only=True):
    """One parameter; without a default each run must set it. Limits are inclusive."""

    type: ParameterType
    default: object = UNSET
    minimum: float | None = None
    maximum: float | None = None
    unit: Annotated[str, Meta(description="SI unit, shown after the value")] = ""
    choices: tuple[object, ...] = ()
    cell_name: Annotated[str, Meta(description="Kind of thing of the cell that a text names: robot, part, camera")] = ""
    entry: Annotated[str, Meta(description="Kind of the entry that a text names: joints, pose")] = ""
    label: Annotated[str, Meta(description="Label in the form; the name if empty")] = ""
    description: str = ""

    @property
    def required(self) -> bool:
        """True if a run cannot start without a value for it."""
        return self.default is UNSET

    @property
    def value_type(self) -> object:
        """The Python type of its values."""
        return _KINDS[self.type]

    def naming(self) -> dict[str, object]:
        """Return what its value names, in the words of the parameters of states; empty if it names nothing."""
        return {word: kind for word, kind in (("cell_name", self.cell_name), ("entry", self.entry)) if kind}

    def problem(self, value: object) -> str | None:
        """Return what is wrong with a value; None if it is valid."""
        if not _fits(self.type, value):
            return f"{value!r} is not {_WORDS[self.type]}"
        if isinstance(value, int | float) and not isinstance(value, bool):
            if self.minimum is not None and value < self.minimum:
                return f"{value} is below the minimum {self.minimum:g}{self._unit()}"
            if self.maximum is not None and value > self.maximum:
                return f"{value} is above the maximum {self.maximum:g}{self._unit()}"
        if self.choices and value not in self.choices:
            return f"{value!r} is none of {', '.join(repr(choice) for choice in self.choices)}"
        return None

    def normal(self, value: object) -> object:
        """Return a valid value as used in a run: numbers as float, lists and mappings unchanged."""
        return float(value) if self.type == "number" and isinstance(value, int | float) else value

    def from_text(self, text: str) -> object:
        """Return the value of command-line text: text unchanged, everything else as JSON.

        Raises:
            DocumentError: the text is not JSON of this type.
        """
        if self.type == "string":
            return text
        try:
            return msgspec.json.decode(text)
        except msgspec.DecodeError as error:
            raise DocumentError(f"{text!r} is not {_WORDS[self.type]}") from error

    def json_schema(self) -> dict[str, object]:
        """Return the parameter as JSON Schema for a form, with `unit` in addition to the standard keys."""
        schema: dict[str, object] = dict(msgspec.json.schema(_KINDS[self.type], schema_hook=any_value))
        schema |= {"minimum": self.minimum} if self.minimum is not None else {}
        schema |= {"maximum": self.maximum} if self.maximum is not None else {}
        schema |= {"enum": list(self.choices)} if self.choices else {}
        schema |= {"default": self.default} if not self.required else {}
        schema |= self.naming()
        texts = {"title": self.label, "description": self.description, "unit": self.unit}
        return schema | {key: text for key, text in texts.items() if text}

    def _unit(self) -> str:
        return f" {self.unit}" if self.unit else ""


def bind_parameters(
    parameters: Mapping[str, ParameterSpec], given: Mapping[str, object], *, where: object | None = None
) -> dict[str, object]:
    """Return a value for every parameter: the given value or the default.

    Raises:
        DocumentError: an unknown name, or a missing or invalid value; `where` is passed through.
    """
    for name in given:
        if name not in parameters:
            raise DocumentError(f"there is no parameter `{name}`", where=where, hint=did_you_mean(name, parameters))
    values: dict[str, object] = {}
    for name, parameter in parameters.items():
        if name not in given and parameter.required:
            raise DocumentError(
                f"the parameter `{name}` is missing", where=where, hint=f"set it to {_WORDS[parameter.type]}"
            )
        value = given.get(name, parameter.default)
        problem = parameter.problem(value)
        if problem:
            raise DocumentError(f"parameter `{name}`: {problem}", where=where, hint=parameter.description or None)
        values[name] = parameter.normal(value)
    return values


def any_value(kind: type) -> dict[str, object]:
    """Return the JSON Schema of `object`: any value is allowed.

    Raises:
        NotImplementedError: for any other type unknown to the generator.
    """
    if kind is object:
        return {"description": "any value"}
    raise NotImplementedError(f"no JSON Schema is known for {kind!r}")


def _fits(kind: ParameterType, value: object) -> bool:
    try:
        msgspec.convert(value, _KINDS[kind])
    except msgspec.ValidationError:
        return False
    return True
