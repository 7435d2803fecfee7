"""Conditions over a message: expressions that are evaluated for each message, not once when a state is entered."""

from __future__ import annotations

from collections.abc import Callable

from engine.document import compile_template
from engine.errors import ExpressionError

_MESSAGE = "message"


def compile_condition(text: str) -> Callable[[object], bool]:
    """Return the condition as a function of a message as plain data; an empty text is met by every message.

    Raises:
        ValueError: it is no expression, or reads more than `message`.
    """
    if not text.strip():
        return lambda _message: True
    try:
        template = compile_template(f"${{{text}}}")
    except ExpressionError as error:
        raise ValueError(f"the condition is no expression: {error.message}") from error
    others = sorted(template.names - {_MESSAGE})
    if others:
        raise ValueError(
            f"the condition reads `{others[0]}`, but only `message` is known when it is evaluated; "
            f"write ${{{others[0]}}} for the value that it has when the state is entered"
        )

    def met(message: object) -> bool:
        value = template.evaluate({_MESSAGE: message})
        if not isinstance(value, bool):
            raise ExpressionError(
                f"the condition `{text}` is {value!r}, which is neither true nor false",
                hint="compare the value: message.value == 'start'",
            )
        return value

    return met
