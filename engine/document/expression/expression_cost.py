"""Upper bound of the evaluation cost of an expression, from its syntax and the sizes of its variables.

The unit is a step of about one microsecond. The constants are those of the slowest measured inputs;
`benchmarks/hostile_inputs.py` compares them with the clock. Unknown functions are refused, so that every
evaluation has a known bound.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from engine.document.expression.cel_syntax import (
    CelCall,
    CelComprehension,
    CelIdentifier,
    CelList,
    CelLiteral,
    CelMap,
    CelSelect,
    Syntax,
)
from engine.document.expression.pattern_cost import pattern_weight
from engine.document.expression.value_size import SCALAR, ValueSize, either_size, joined_size, list_size, text_size
from engine.errors import ExpressionError

MAX_STEPS = 10_000.0
"""Maximum cost of one evaluation: 10 ms."""

Sizes = Mapping[str, ValueSize]

_START = 10.0
_NODE = 0.15
_READ = 1.0
"""Steps per unit of weight passed to the evaluator."""
_RESULT = 1.5
"""Steps per unit of weight returned."""
_ROUND = 0.4
_ADD = 5.0
"""Steps per item that `filter` and similar macros add, including the condition."""
_COPY = 0.2
"""Steps per copied item when lists are joined; `map` and `filter` join one item at a time."""
_COMPARE = 0.3
_FIND = 0.1
_ARITHMETIC = 4.0
_CHARACTER = 0.004
_ENDLESS = 1e15
_ZONE = re.compile(r"[A-Za-z][A-Za-z0-9_+-]*(?:/[A-Za-z0-9_+-]+){0,2}|[+-]?\d\d:\d\d")


@dataclass(frozen=True, slots=True)
class ExpressionCost:
    """Upper bounds: of the steps of an evaluation, and of the size of its value."""

    steps: float
    result: ValueSize


def cost_of(root: Syntax, sizes: Sizes) -> ExpressionCost:
    """Return the cost bound of an expression with variables of these sizes; missing ones count as minimal.

    Raises:
        ExpressionError: it uses a function or message of unknown cost.
    """
    counting = _Counting(_START + _READ * sum(size.weight for size in sizes.values()))
    result = counting.size(root, sizes)
    return ExpressionCost(min(counting.steps + _RESULT * result.weight, _ENDLESS), result)


class _Counting:
    """One walk over a syntax tree."""

    def __init__(self, steps: float = 0.0) -> None:
        self.steps = steps

    def size(self, node: Syntax, sizes: Sizes) -> ValueSize:
        """Return the size of the value of a node, adding its cost."""
        self.steps += _NODE
        match node:
            case CelLiteral():
                return text_size(len(node.text), node.text) if node.text is not None else SCALAR
            case CelIdentifier():
                return sizes.get(node.name, SCALAR)
            case CelSelect():
                found = self.size(node.operand, sizes).inside
                return SCALAR if node.test else found
            case CelCall():
                return self._call(node, sizes)
            case CelList():
                return self._items(node.items, sizes)
            case CelMap():
                if node.message:
                    raise _unknown(node.message)
                return self._items(node.items, sizes)
            case CelComprehension():
                return self._fold(node, sizes)

    def added(self, node: CelComprehension, inside: Sizes) -> ValueSize | None:
        """Return the size of the values that a round adds, adding its cost; each nested node counts once."""
        appended = _appended(node)
        if appended is None:
            self.size(node.step, inside)
            return None
        if isinstance(node.step, CelCall) and _is_conditional(node.step):
            self.size(node.step.arguments[0], inside)
            self.steps += _ADD
        return self.size(appended, inside)

    def _items(self, items: tuple[Syntax, ...], sizes: Sizes) -> ValueSize:
        weight, item = 1.0, None
        for each in items:
            found = self.size(each, sizes)
            weight += found.weight
            item = either_size(item, found) if item is not None else found
        self.steps += _COPY * len(items)
        return ValueSize(min(weight, _ENDLESS), 0.0, float(len(items)), item)

    def _call(self, node: CelCall, sizes: Sizes) -> ValueSize:
        if node.function == "_?_:_":
            return self._choice(node.arguments, sizes)
        charge = _CHARGES.get(node.function)
        if charge is None or (node.function in _OF_TWO and len(node.arguments) != 2):
            raise _unknown(node.function)
        steps, result = charge([self.size(each, sizes) for each in node.arguments])
        self.steps = min(self.steps + steps, _ENDLESS)
        return result

    def _choice(self, arguments: tuple[Syntax, ...], sizes: Sizes) -> ValueSize:
        condition, one, other = arguments
        self.size(condition, sizes)
        return either_size(self.size(one, sizes), self.size(other, sizes))

    def _fold(self, node: CelComprehension, sizes: Sizes) -> ValueSize:
        values = self.size(node.values, sizes)
        self.size(node.start, sizes)
        inside = {**sizes, node.variable: values.inside, node.accumulator: SCALAR}
        each = _Counting(_ROUND)
        each.size(node.condition, inside)
        item = each.added(node, inside)
        rounds = values.length
        # `map` appends one item per round, and copies all previous items.
        copied = _COPY * rounds * (rounds + 1) / 2 if item is not None and item.length else 0.0
        self.steps = min(self.steps + rounds * each.steps + copied, _ENDLESS)
        made = list_size(rounds * item.length, item.inside) if item is not None and item.length else SCALAR
        return self.size(node.result, {**sizes, node.accumulator: made})


def _appended(node: CelComprehension) -> Syntax | None:
    """Return the expression that a round adds to the accumulator; None if it is a truth value."""
    step = node.step
    if isinstance(step, CelCall) and _is_conditional(step):
        step = step.arguments[1]
    if isinstance(step, CelCall) and step.function in ("_||_", "_&&_"):
        return None
    if isinstance(step, CelCall) and step.function == "_+_" and _is_name(step.arguments[0], node.accumulator):
        return step.arguments[1]
    raise _unknown("comprehension")


def _is_conditional(step: Syntax) -> bool:
    return isinstance(step, CelCall) and step.function == "_?_:_"


def _is_name(node: Syntax, name: str) -> bool:
    return isinstance(node, CelIdentifier) and node.name == name


def _unknown(name: str) -> ExpressionError:
    return ExpressionError(f"`{name}` cannot be used in an expression", hint="use a state instead")


_Charge = Callable[[list[ValueSize]], tuple[float, ValueSize]]


def _scalar(steps: float) -> _Charge:
    return lambda given: (steps + _CHARACTER * max((each.text for each in given), default=0.0), SCALAR)


def _join(given: list[ValueSize]) -> tuple[float, ValueSize]:
    made = joined_size(*given) if len(given) == 2 and any(each.text or each.length for each in given) else SCALAR
    return _ARITHMETIC + _CHARACTER * made.text + _COPY * made.length, made


def _compare(given: list[ValueSize]) -> tuple[float, ValueSize]:
    return _COMPARE * min((each.weight for each in given), default=1.0), SCALAR


def _find(given: list[ValueSize]) -> tuple[float, ValueSize]:
    sought, values = given
    alike = min(sought.weight, values.inside.weight)
    return values.length * (_FIND + (_COMPARE * alike if alike > 1 else 0.0)), SCALAR


def _contains(given: list[ValueSize]) -> tuple[float, ValueSize]:
    text, part = (each.text for each in given)
    return 1 + _CHARACTER * text + text * part / 10_000, SCALAR


def _matches(given: list[ValueSize]) -> tuple[float, ValueSize]:
    text, pattern = given
    if pattern.literal is None and pattern.text:
        hint = "write it as literal text, or pass it as one parameter or key"
        raise ExpressionError("the pattern of `matches` is computed", hint=hint)
    weight = pattern_weight(pattern.literal or "")
    return 20 + 2 * weight + text.text * weight / 10, SCALAR


def _zoned(given: list[ValueSize]) -> tuple[float, ValueSize]:
    # The evaluator opens the time zone file for any name.
    if len(given) > 1 and not _ZONE.fullmatch(given[1].literal or ""):
        raise ExpressionError("this is not a time zone", hint="write it as `Europe/Berlin` or `+02:00`")
    return 5.0, SCALAR


def _text(given: list[ValueSize]) -> tuple[float, ValueSize]:
    characters = 4 * max((each.text for each in given), default=0.0) + 40
    return 1 + _CHARACTER * characters, text_size(characters)


_OF_TWO = frozenset(("_[_]", "@in", "contains", "matches"))
_ZONED = ("FullYear", "Month", "Date", "DayOfMonth", "DayOfWeek", "DayOfYear", "Hours", "Minutes", "Seconds")
_CHARGES: Mapping[str, _Charge] = {
    **dict.fromkeys(("_<_", "_<=_", "_>_", "_>=_", "!_", "-_", "_%_", "_&&_", "_||_"), _scalar(_NODE)),
    **dict.fromkeys(("_-_", "_*_", "_/_"), _scalar(_ARITHMETIC)),
    **dict.fromkeys(("@not_strictly_false", "__not_strictly_false__", "type"), _scalar(_NODE)),
    **dict.fromkeys(("size", "int", "uint", "double", "bool", "timestamp", "duration"), _scalar(1.0)),
    **dict.fromkeys(("startsWith", "endsWith"), _scalar(1.0)),
    **dict.fromkeys((f"get{part}" for part in (*_ZONED, "Milliseconds")), _zoned),
    "_+_": _join,
    "_==_": _compare,
    "_!=_": _compare,
    "@in": _find,
    "_[_]": lambda given: (_NODE, given[0].inside),
    "contains": _contains,
    "matches": _matches,
    "string": _text,
    "bytes": _text,
    "dyn": lambda given: (0.0, given[0]),
}
