"""Verifies that the annotations of a handler match its skill."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any, get_args, get_origin, get_type_hints

from engine.errors import HandlerNotTyped
from engine.skill import Action, Skill


def verify_handler(skill: type[Skill[Any]], handler: Callable[..., Any], address: str) -> None:
    """Check that `handler` is annotated with the skill's request, result and feedback types.

    Raises:
        HandlerNotTyped: an annotation is missing or names another type.
    """
    expected = expected_signature(skill)
    name = getattr(handler, "__qualname__", repr(handler))
    try:
        hints = get_type_hints(handler)
    except (NameError, TypeError) as error:
        raise HandlerNotTyped(
            f"the annotations of {name} cannot be resolved: {error}", where=address, hint=f"write it as {expected}"
        ) from error
    parameters = [p for p in inspect.signature(handler).parameters.values() if p.default is p.empty]
    actual_types = [hints.get(parameter.name) for parameter in parameters]
    expected_types: list[Any] = [skill]
    if issubclass(skill, Action):
        expected_types.append(skill.feedback_type())
        if len(actual_types) == 2:
            actual_types[1] = _goal_argument(actual_types[1])
    if actual_types != expected_types or hints.get("return", inspect.Parameter.empty) != skill.result_type():
        raise HandlerNotTyped(
            f"the annotations of {name} do not match its skill", where=address, hint=f"write it as {expected}"
        )


def expected_signature(skill: type[Skill[Any]]) -> str:
    """Return the signature that a handler of `skill` must have, as text."""
    result = _type_name(skill.result_type())
    if issubclass(skill, Action):
        feedback = _type_name(skill.feedback_type())
        return f"async def handler(goal: {skill.__name__}, handle: ActiveGoal[{feedback}]) -> {result}"
    return f"async def handler(request: {skill.__name__}) -> {result}"


def _goal_argument(hint: Any) -> Any:
    arguments = get_args(hint)
    named = getattr(get_origin(hint), "__name__", "")
    return arguments[0] if named == "ActiveGoal" and arguments else None


def _type_name(kind: Any) -> str:
    return getattr(kind, "__name__", str(kind))
