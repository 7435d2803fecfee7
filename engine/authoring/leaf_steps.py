"""Leaf steps: states, and references to other behaviors."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Unpack, cast, overload

import msgspec

from engine.authoring.plain_data import has_expression, to_plain_data
from engine.authoring.source_location import calling_position
from engine.authoring.steps import PartKeys, Step, StepKeys, TreePart, new_part, new_step, with_keys
from engine.document.behavior import Behavior
from engine.document.signature import read_signature
from engine.errors import DocumentError, Position
from engine.state import State
from engine.wording.misfit import explain_misfit

_NOTHING: Mapping[str, object] = {}
_NO_KEYS: Mapping[str, str] = {}


@overload
def state(
    what: State,
    *,
    inputs: Mapping[str, str] = _NO_KEYS,
    outputs: Mapping[str, str] = _NO_KEYS,
    **keys: Unpack[StepKeys],
) -> Step: ...


@overload
def state(
    what: type[State] | str,
    *,
    parameters: Mapping[str, object] = _NOTHING,
    inputs: Mapping[str, str] = _NO_KEYS,
    outputs: Mapping[str, str] = _NO_KEYS,
    **keys: Unpack[StepKeys],
) -> Step: ...


def state(
    what: State | type[State] | str,
    *,
    parameters: Mapping[str, object] = _NOTHING,
    inputs: Mapping[str, str] = _NO_KEYS,
    outputs: Mapping[str, str] = _NO_KEYS,
    **keys: Unpack[StepKeys],
) -> Step:
    """Run a state.

    Args:
        what: An instance whose fields are the parameters; or a class or its name, with `parameters`.
        parameters: Values by name. Text in them is document text: `${…}` is an expression.
        inputs: Maps input keys of the state to the userdata keys that they are read from.
        outputs: Maps output keys of the state to the userdata keys that they are written to.
        **keys: Common keys of steps.

    Raises:
        DocumentError: the class cannot be named in a document, or the parameters are invalid.
    """
    place = calling_position()
    if isinstance(what, State):
        parameters = _parameters_of(what, place)
    name = what if isinstance(what, str) else _name_of(what if isinstance(what, type) else type(what), place)
    plain = to_plain_data(parameters, what=f"the parameters of {name}", where=place)
    return with_keys(new_step("state", name, **keys), {"with": plain, "in": dict(inputs), "out": dict(outputs)})


def reference(
    target: Behavior | str,
    *,
    parameters: Mapping[str, object] = _NOTHING,
    inputs: Mapping[str, str] = _NO_KEYS,
    outputs: Mapping[str, str] = _NO_KEYS,
    **keys: Unpack[StepKeys],
) -> Step:
    """Run another behavior: one built in Python or loaded, or a file relative to the document.

    Args:
        target: The behavior.
        parameters: Values of its parameters by name.
        inputs: Maps its userdata keys to the keys here with their initial values.
        outputs: Maps its userdata keys to the keys here that they are copied to at the end.
        **keys: Common keys of steps.
    """
    plain = to_plain_data(parameters, what="the parameters", where=calling_position())
    step = new_step("behavior", target, **keys)
    return with_keys(step, {"with": plain, "in": dict(inputs), "out": dict(outputs)})


def behaviour(what: str, *, parameters: Mapping[str, object] = _NOTHING, **keys: Unpack[PartKeys]) -> TreePart:
    """Add a py_trees `Behaviour` to a tree, named as `module:Class`; `parameters` go to its constructor."""
    plain = to_plain_data(parameters, what=f"the parameters of {what}", where=calling_position())
    part = new_part("behaviour", what, **keys)
    return TreePart(keys={**part.keys, **({"with": plain} if plain else {})}, place=part.place)


def _parameters_of(what: State, place: Position) -> Mapping[str, object]:
    """Return the parameters of a state instance, after checking that a document represents them equally."""
    kind = type(what)
    plain = cast("dict[str, object]", to_plain_data(what, what=f"a parameter of {kind.__name__}", where=place))
    if not has_expression(plain):
        try:
            msgspec.convert(plain, kind)
        except msgspec.ValidationError as error:
            problem = explain_misfit(error, kind)
            raise DocumentError(f"the parameters of {kind.__name__} are invalid: {problem}", where=place) from error
    return plain


def _name_of(kind: type[State], place: Position) -> str:
    """Return the name of a class in documents."""
    name = read_signature(kind).name
    if ":" in name and ("<locals>" in name or name.startswith("__main__:")):
        raise DocumentError(
            f"no document can name the state class {name}",
            where=place,
            hint="define it at the top of a module that can be imported, or give it a `state_name`",
        )
    return name
