"""What a URScript program consists of: expressions, statements and functions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


class UrscriptError(Exception):
    """Text that is no URScript, or a program that cannot go on; says the line."""

    def __init__(self, message: str, line: int = 0) -> None:
        super().__init__(f"line {line}: {message}" if line else message)


@dataclass(frozen=True, slots=True)
class Literal:
    """A number, a text or a truth value."""

    value: float | int | str | bool


@dataclass(frozen=True, slots=True)
class VariableName:
    """A variable that is read."""

    name: str
    line: int


@dataclass(frozen=True, slots=True)
class ListLiteral:
    """`[…]`, or a pose `p[…]`."""

    items: tuple[Expression, ...]
    is_pose: bool


@dataclass(frozen=True, slots=True)
class IndexExpression:
    """`target[index]`."""

    target: Expression
    index: Expression
    line: int


@dataclass(frozen=True, slots=True)
class UnaryExpression:
    """`-x`, `+x` or `not x`."""

    operator: str
    operand: Expression
    line: int


@dataclass(frozen=True, slots=True)
class BinaryExpression:
    """Two operands with an operator between them."""

    operator: str
    left: Expression
    right: Expression
    line: int


@dataclass(frozen=True, slots=True)
class CallExpression:
    """A call of a function of the program or of the controller; `is_thread` for `run f()`."""

    function: str
    arguments: tuple[Expression, ...]
    named: tuple[tuple[str, Expression], ...]
    line: int
    is_thread: bool = False


Expression = (
    Literal | VariableName | ListLiteral | IndexExpression | UnaryExpression | BinaryExpression | CallExpression
)


@dataclass(frozen=True, slots=True)
class ExpressionStatement:
    """An expression for its effect."""

    value: Expression


@dataclass(frozen=True, slots=True)
class Assignment:
    """`name = value`, or `name[index] = value`."""

    name: str
    index: Expression | None
    value: Expression
    line: int
    is_local: bool = False


@dataclass(frozen=True, slots=True)
class IfStatement:
    """The first branch whose condition holds; the last one may have none."""

    branches: tuple[tuple[Expression | None, tuple[Statement, ...]], ...]


@dataclass(frozen=True, slots=True)
class WhileStatement:
    """Repeats while the condition holds."""

    condition: Expression
    body: tuple[Statement, ...]


@dataclass(frozen=True, slots=True)
class ReturnStatement:
    """Leaves a function."""

    value: Expression | None


@dataclass(frozen=True, slots=True)
class SimpleStatement:
    """`break`, `continue`, `halt`, `pass`, `enter_critical` or `exit_critical`."""

    keyword: str


@dataclass(frozen=True, slots=True)
class ThreadStatement:
    """`kill` or `join` of a thread."""

    keyword: str
    thread: Expression


Statement = (
    ExpressionStatement
    | Assignment
    | IfStatement
    | WhileStatement
    | ReturnStatement
    | SimpleStatement
    | ThreadStatement
)


@dataclass(frozen=True, slots=True)
class UrscriptFunction:
    """A function or a thread; a parameter may have a default."""

    name: str
    parameters: tuple[tuple[str, Expression | None], ...]
    body: tuple[Statement, ...]


@dataclass(frozen=True, slots=True)
class UrscriptProgram:
    """A parsed program. `is_secondary`: a `sec` program, which runs beside the main one and may not move."""

    name: str
    body: tuple[Statement, ...]
    functions: Mapping[str, UrscriptFunction] = field(default_factory=dict[str, UrscriptFunction])
    global_names: frozenset[str] = frozenset()
    is_secondary: bool = False
