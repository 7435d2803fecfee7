"""The operators of URScript."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping

from robots.drivers.universal_robots.emulator.urscript.urscript_syntax import UrscriptError
from robots.drivers.universal_robots.emulator.urscript.urscript_values import (
    UrscriptList,
    UrscriptValue,
    number_of,
    text_of,
)

_LARGEST = 1 << 63
_ARITHMETIC: Mapping[str, Callable[[float, float], float]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": lambda left, right: left / right,
    "%": operator.mod,
}
_COMPARISONS: Mapping[str, Callable[[float, float], bool]] = {
    "<": operator.lt,
    ">": operator.gt,
    "<=": operator.le,
    ">=": operator.ge,
}


def operate(symbol: str, left: UrscriptValue, right: UrscriptValue, line: int) -> UrscriptValue:
    """Return the result of an operator; one with one operand has it on the right."""
    if symbol == "not":
        return not truth(right)
    if symbol == "xor":
        return truth(left) is not truth(right)
    if symbol in ("==", "!="):
        return (left == right) is (symbol == "==")
    try:
        first, second = 0 if left is None else number_of(left), number_of(right)
        if symbol in _COMPARISONS:
            return _COMPARISONS[symbol](first, second)
        result = _ARITHMETIC[symbol](first, second)
    except (UrscriptError, ArithmeticError) as error:
        raise UrscriptError(f"`{symbol}`: {error}", line) from None
    if abs(result) > _LARGEST and isinstance(result, int):
        raise UrscriptError(f"`{symbol}`: the number is too large", line)
    return result


def truth(value: UrscriptValue) -> bool:
    """Return a truth value; numbers have one too."""
    if isinstance(value, (bool, int, float)):
        return bool(value)
    raise UrscriptError(f"a truth value is expected, not {text_of(value)}")


def element(target: UrscriptValue, index: UrscriptValue, line: int) -> UrscriptValue:
    """Return an element of a list."""
    position = int(number_of(index))
    if not isinstance(target, UrscriptList) or not 0 <= position < len(target):
        raise UrscriptError(f"{text_of(target)} has no element {position}", line)
    return target[position]
