"""Parses URScript. Line ends mean nothing to it, except behind `return`: statements need none between them."""

from __future__ import annotations

from collections.abc import Callable

from robots.drivers.universal_robots.emulator.urscript.urscript_syntax import (
    Assignment,
    BinaryExpression,
    CallExpression,
    Expression,
    ExpressionStatement,
    IfStatement,
    IndexExpression,
    ListLiteral,
    Literal,
    ReturnStatement,
    SimpleStatement,
    Statement,
    ThreadStatement,
    UnaryExpression,
    UrscriptError,
    UrscriptFunction,
    UrscriptProgram,
    VariableName,
    WhileStatement,
)
from robots.drivers.universal_robots.emulator.urscript.urscript_tokens import Token, tokenize

_SIMPLE = frozenset(("break", "continue", "halt", "pass", "enter_critical", "exit_critical"))
_RESERVED = _SIMPLE | {
    *("def", "sec", "thread", "if", "elif", "else", "while", "end", "return", "kill", "join", "run"),
    *("global", "local", "and", "or", "xor", "not", "True", "False"),
}
_LEVELS = (("or", "xor"), ("and",), ("==", "!=", "<", ">", "<=", ">="), ("+", "-"), ("*", "/", "%"))
_MOST_NESTING = 60


def parse_program(source: str) -> UrscriptProgram:
    """Return the program of a text: one `def` or `sec`, or statements alone; raises UrscriptError."""
    return _Parser(tokenize(source)).program()


class _Parser:
    """Reads tokens from the left to the right, one function for each kind of thing."""

    def __init__(self, tokens: list[Token]) -> None:
        self._tokens = tokens
        self._at = 0
        self._nesting = 0
        self._functions: dict[str, UrscriptFunction] = {}
        self._globals: set[str] = set()

    def program(self) -> UrscriptProgram:
        name, is_secondary = "line", False
        if self._token.text in ("def", "sec"):
            is_secondary = self._next().text == "sec"
            name = self._name()
            self._expect("(")
            self._expect(")")
            self._expect(":")
            body = self._block("end")
            self._expect("end")
        else:
            body = self._block()
        if self._token.kind != "end of text":
            raise self._unexpected("the end of the program")
        return UrscriptProgram(name, body, self._functions, frozenset(self._globals), is_secondary)

    @property
    def _token(self) -> Token:
        return self._tokens[self._at]

    def _next(self) -> Token:
        token = self._token
        if token.kind != "end of text":
            self._at += 1
        return token

    def _unexpected(self, expected: str) -> UrscriptError:
        return UrscriptError(f"expected {expected}, not {self._token.text or self._token.kind!r}", self._token.line)

    def _expect(self, text: str) -> None:
        if self._token.text != text or self._token.kind == "text":
            raise self._unexpected(f"`{text}`")
        self._next()

    def _accept(self, *texts: str) -> str:
        """Take the token if it is one of these, and return it; empty if it is none."""
        token = self._token
        if token.kind in ("name", "operator") and token.text in texts:
            self._at += 1
            return token.text
        return ""

    def _name(self) -> str:
        if self._token.kind != "name" or self._token.text in _RESERVED:
            raise self._unexpected("a name")
        return self._next().text

    def _deeper(self, read: Callable[[], Expression]) -> Expression:
        """Read something inside of something; garbage may not exhaust the stack."""
        self._nesting += 1
        if self._nesting > _MOST_NESTING:
            raise UrscriptError(f"more than {_MOST_NESTING} levels of nesting", self._token.line)
        value = read()
        self._nesting -= 1
        return value

    def _block(self, *ends: str) -> tuple[Statement, ...]:
        """Read statements up to one of these words, which is not taken."""
        self._nesting += 1
        if self._nesting > _MOST_NESTING:
            raise UrscriptError(f"more than {_MOST_NESTING} levels of nesting", self._token.line)
        statements: list[Statement] = []
        while self._token.kind != "end of text" and not (self._token.kind == "name" and self._token.text in ends):
            if self._token.kind == "name" and self._token.text in ("def", "thread"):
                self._function()
            else:
                statements.append(self._statement())
        self._nesting -= 1
        return tuple(statements)

    def _function(self) -> None:
        self._next()
        name = self._name()
        self._expect("(")
        parameters: list[tuple[str, Expression | None]] = []
        while not self._accept(")"):
            parameter = self._name()
            parameters.append((parameter, self._expression() if self._accept("=") else None))
            if self._token.text != ")":
                self._expect(",")
        self._expect(":")
        body = self._block("end")
        self._expect("end")
        self._functions[name] = UrscriptFunction(name, tuple(parameters), body)

    def _statement(self) -> Statement:
        token = self._token
        if token.kind == "pose":
            # An element of a variable called `p`.
            self._next()
            return self._assignment("p", token.line, is_local=False, has_index=True)
        if token.kind != "name":
            raise self._unexpected("a statement")
        if token.text in _SIMPLE:
            return SimpleStatement(self._next().text)
        if word := self._accept("kill", "join"):
            return ThreadStatement(word, self._expression())
        if self._accept("if"):
            return self._if()
        if self._accept("while"):
            condition = self._expression()
            self._expect(":")
            body = self._block("end")
            self._expect("end")
            return WhileStatement(condition, body)
        if self._accept("return"):
            has_value = (
                self._token.line == token.line and self._token.kind != "end of text" and self._token.text != "end"
            )
            return ReturnStatement(self._expression() if has_value else None)
        if self._accept("run"):
            return ExpressionStatement(self._thread_call())
        return self._assignment_or_call()

    def _assignment_or_call(self) -> Statement:
        scope = self._accept("global", "local")
        line = self._token.line
        name = self._name()
        if scope == "global":
            self._globals.add(name)
        if not scope and self._token.text == "(":
            return ExpressionStatement(self._call(name, line))
        return self._assignment(name, line, is_local=scope == "local", has_index=bool(self._accept("[")))

    def _assignment(self, name: str, line: int, *, is_local: bool, has_index: bool) -> Assignment:
        index: Expression | None = None
        if has_index:
            index = self._expression()
            self._expect("]")
        self._expect("=")
        return Assignment(name, index, self._expression(), line, is_local)

    def _if(self) -> IfStatement:
        branches: list[tuple[Expression | None, tuple[Statement, ...]]] = []
        while True:
            condition = self._expression()
            self._expect(":")
            branches.append((condition, self._block("elif", "else", "end")))
            if not self._accept("elif"):
                break
        if self._accept("else"):
            self._expect(":")
            branches.append((None, self._block("end")))
        self._expect("end")
        return IfStatement(tuple(branches))

    def _expression(self, level: int = 0) -> Expression:
        if level == 0:
            return self._deeper(lambda: self._operators(0))
        return self._operators(level)

    def _operators(self, level: int) -> Expression:
        if level == len(_LEVELS):
            return self._unary()
        left = self._operators(level + 1)
        line = self._token.line
        while operator := self._accept(*_LEVELS[level]):
            left = BinaryExpression(operator, left, self._operators(level + 1), line)
        return left

    def _unary(self) -> Expression:
        line = self._token.line
        if operator := self._accept("-", "+", "not"):
            # `not` holds for a whole comparison, a sign for what stands behind it.
            operand = self._deeper((lambda: self._operators(2)) if operator == "not" else self._unary)
            return UnaryExpression(operator, operand, line)
        if self._accept("run"):
            return self._thread_call()
        value = self._primary()
        while self._token.text == "[" and self._token.kind == "operator":
            self._next()
            value = IndexExpression(value, self._expression(), line)
            while self._accept(","):
                value = IndexExpression(value, self._expression(), line)
            self._expect("]")
        return value

    def _primary(self) -> Expression:
        token = self._token
        if token.kind == "number":
            text = self._next().text
            return Literal(int(text) if text.isdigit() and len(text) < 20 else float(text))
        if token.kind == "text":
            return Literal(self._next().text[1:-1])
        if self._accept("("):
            value = self._expression()
            self._expect(")")
            return value
        if token.kind == "pose":
            self._next()
            items = self._items("]")
            # `p` may also be the name of a variable.
            if len(items) == 1:
                return IndexExpression(VariableName("p", token.line), items[0], token.line)
            return ListLiteral(items, is_pose=True)
        if self._accept("["):
            return ListLiteral(self._items("]"), is_pose=False)
        if word := self._accept("True", "False"):
            return Literal(word == "True")
        name = self._name()
        return self._call(name, token.line) if self._token.text == "(" else VariableName(name, token.line)

    def _items(self, end: str) -> tuple[Expression, ...]:
        items: list[Expression] = []
        while not self._accept(end):
            items.append(self._expression())
            if self._token.text != end:
                self._expect(",")
        return tuple(items)

    def _thread_call(self) -> CallExpression:
        line = self._token.line
        call = self._call(self._name(), line)
        return CallExpression(call.function, call.arguments, call.named, line, is_thread=True)

    def _call(self, function: str, line: int) -> CallExpression:
        self._expect("(")
        arguments: list[Expression] = []
        named: list[tuple[str, Expression]] = []
        while not self._accept(")"):
            following = self._tokens[self._at + 1] if self._at + 1 < len(self._tokens) else self._token
            if self._token.kind == "name" and following.text == "=":
                name = self._name()
                self._next()
                named.append((name, self._expression()))
            else:
                arguments.append(self._expression())
            if self._token.text != ")":
                self._expect(",")
        return CallExpression(function, tuple(arguments), tuple(named), line)
