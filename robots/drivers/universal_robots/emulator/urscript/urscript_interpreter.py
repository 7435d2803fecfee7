"""Executes URScript: each thread of a program is a generator that runs until it has to wait for the next cycle."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from enum import Enum, auto

from robots.drivers.universal_robots.emulator.arm_motions import UnreachableError
from robots.drivers.universal_robots.emulator.controller_state import ControllerState
from robots.drivers.universal_robots.emulator.urscript.urscript_functions import FUNCTIONS
from robots.drivers.universal_robots.emulator.urscript.urscript_motions import TIMED_FUNCTIONS
from robots.drivers.universal_robots.emulator.urscript.urscript_operators import element, operate, truth
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
    UrscriptProgram,
    VariableName,
    WhileStatement,
)
from robots.drivers.universal_robots.emulator.urscript.urscript_values import (
    UrscriptArguments,
    UrscriptList,
    UrscriptValue,
    copied,
    number_of,
)

Frame = dict[str, UrscriptValue]
Evaluation = Generator[None, None, UrscriptValue]
MAIN_THREAD = 1
_STATEMENTS_PER_CYCLE = 400
_MOST_CALLS = 30
_MOST_THREADS = 50


class _BlockEnd(Enum):
    """Why a block has ended."""

    DONE = auto()
    BREAK = auto()
    CONTINUE = auto()
    RETURN = auto()


class _HaltError(Exception):
    """`halt`: the program ends."""


Execution = Generator[None, None, tuple[_BlockEnd, UrscriptValue]]
_DONE: tuple[_BlockEnd, UrscriptValue] = (_BlockEnd.DONE, None)


class UrscriptRun:
    """One execution of a program on a controller."""

    def __init__(self, program: UrscriptProgram, controller: ControllerState) -> None:
        self._program = program
        self._controller = controller
        self._globals: Frame = {}
        self._main_frame: Frame = {}
        self._threads: dict[int, Generator[None, None, object]] = {
            MAIN_THREAD: self._block(program.body, self._main_frame)
        }
        self._next_handle = MAIN_THREAD + 1
        self._current = MAIN_THREAD
        self._critical: int | None = None
        self._statements = 0
        self._calls: dict[int, int] = {}
        self._with_calls: dict[int, bool] = {}

    @property
    def name(self) -> str:
        """The name of the program."""
        return self._program.name

    def step(self) -> bool:
        """Execute one cycle of all threads; returns whether the program goes on. ArmLimitError passes through."""
        try:
            for handle in list(self._threads):
                if handle in self._threads and self._critical in (None, handle):
                    self._step_thread(handle)
                    if MAIN_THREAD not in self._threads:
                        return False
        except _HaltError:
            return False
        # What a program does with values of the wrong kind is an error of the program, as a wrong text is.
        except (
            UrscriptError,
            UnreachableError,
            ArithmeticError,
            LookupError,
            TypeError,
            ValueError,
            RecursionError,
        ) as error:
            self._controller.messages.append(f"program {self.name} ended: {error}")
            return False
        return True

    def _step_thread(self, handle: int) -> None:
        self._current, self._statements = handle, 0
        try:
            next(self._threads[handle])
        except StopIteration:
            self._end_thread(handle)

    def _end_thread(self, handle: int) -> None:
        """End a thread, but never the main one: a variable that holds no thread may be killed."""
        self._threads.pop(handle, None)
        self._calls.pop(handle, None)
        if self._critical == handle:
            self._critical = None

    def _block(self, statements: Sequence[Statement], frame: Frame) -> Execution:
        for statement in statements:
            self._statements += 1
            if self._statements > _STATEMENTS_PER_CYCLE:
                yield
            ended = yield from self._statement(statement, frame)
            if ended[0] is not _BlockEnd.DONE:
                return ended
        return _DONE

    def _statement(self, statement: Statement, frame: Frame) -> Execution:
        match statement:
            case ExpressionStatement(value):
                yield from self._evaluate(value, frame)
            case Assignment():
                yield from self._assign(statement, frame)
            case IfStatement(branches):
                for condition, body in branches:
                    if condition is None or truth((yield from self._evaluate(condition, frame))):
                        return (yield from self._block(body, frame))
            case WhileStatement(condition, body):
                return (yield from self._while(condition, body, frame))
            case ReturnStatement(value):
                return _BlockEnd.RETURN, None if value is None else (yield from self._evaluate(value, frame))
            case ThreadStatement(keyword, thread):
                yield from self._kill_or_join(keyword, int(number_of((yield from self._evaluate(thread, frame)))))
            case SimpleStatement(keyword):
                return (yield from self._simple(keyword))
        return _DONE

    def _while(self, condition: Expression, body: Sequence[Statement], frame: Frame) -> Execution:
        while truth((yield from self._evaluate(condition, frame))):
            self._statements += 1
            if self._statements > _STATEMENTS_PER_CYCLE:
                yield
            ended = yield from self._block(body, frame)
            if ended[0] is _BlockEnd.BREAK:
                break
            if ended[0] is _BlockEnd.RETURN:
                return ended
        return _DONE

    def _simple(self, keyword: str) -> Execution:
        match keyword:
            case "break":
                return _BlockEnd.BREAK, None
            case "continue":
                return _BlockEnd.CONTINUE, None
            case "halt":
                raise _HaltError
            case "enter_critical":
                # Until the end of the section no other thread is executed, also while this one waits for a motion.
                self._critical = self._current
            case "exit_critical":
                self._critical = None
            case _:
                pass
        return _DONE
        yield  # a generator as all others

    def _kill_or_join(self, keyword: str, handle: int) -> Generator[None]:
        if keyword == "kill":
            if handle not in (MAIN_THREAD, self._current):
                self._end_thread(handle)
            return
        while handle in self._threads:
            yield

    def _assign(self, statement: Assignment, frame: Frame) -> Generator[None]:
        value = copied((yield from self._evaluate(statement.value, frame)))
        name = statement.name
        scope = self._globals if name in self._program.global_names and not statement.is_local else frame
        if statement.index is None:
            scope[name] = value
            return
        index = int(number_of((yield from self._evaluate(statement.index, frame))))
        target = self._variable(name, frame, statement.line)
        if not isinstance(target, UrscriptList) or not 0 <= index < len(target):
            raise UrscriptError(f"`{name}` has no element {index}", statement.line)
        target[index] = value

    def _variable(self, name: str, frame: Frame, line: int) -> UrscriptValue:
        for scope in (frame, self._globals, self._main_frame):
            if name in scope:
                return scope[name]
        raise UrscriptError(f"variable `{name}` has no value", line)

    def _has_call(self, expression: Expression) -> bool:
        """Whether an expression may have to wait; the others are evaluated without generators."""
        known = self._with_calls.get(id(expression))
        if known is None:
            match expression:
                case CallExpression():
                    known = True
                case ListLiteral(items, _):
                    known = any(self._has_call(item) for item in items)
                case IndexExpression(left, right, _) | BinaryExpression(_, left, right, _):
                    known = self._has_call(left) or self._has_call(right)
                case UnaryExpression(_, operand, _):
                    known = self._has_call(operand)
                case _:
                    known = False
            self._with_calls[id(expression)] = known
        return known

    def _value(self, expression: Expression, frame: Frame) -> UrscriptValue:
        """Evaluate an expression without calls."""
        match expression:
            case Literal(value):
                return value
            case VariableName(name, line):
                return self._variable(name, frame, line)
            case BinaryExpression(operator, left, right, line):
                first = self._value(left, frame)
                if operator in ("and", "or"):
                    return truth(self._value(right, frame)) if truth(first) is (operator == "and") else truth(first)
                return operate(operator, first, self._value(right, frame), line)
            case UnaryExpression(operator, operand, line):
                return operate(operator, None, self._value(operand, frame), line)
            case IndexExpression(target, index, line):
                return element(self._value(target, frame), self._value(index, frame), line)
            case ListLiteral(items, is_pose):
                return UrscriptList([copied(self._value(item, frame)) for item in items], is_pose=is_pose)
            case CallExpression():
                raise UrscriptError("a call cannot be evaluated here", expression.line)

    def _evaluate(self, expression: Expression, frame: Frame) -> Evaluation:
        if not self._has_call(expression):
            return self._value(expression, frame)
        match expression:
            case CallExpression():
                return (yield from self._call(expression, frame))
            case BinaryExpression(operator, left, right, line):
                first = yield from self._evaluate(left, frame)
                if operator in ("and", "or"):
                    if truth(first) is not (operator == "and"):
                        return truth(first)
                    return truth((yield from self._evaluate(right, frame)))
                return operate(operator, first, (yield from self._evaluate(right, frame)), line)
            case UnaryExpression(operator, operand, line):
                return operate(operator, None, (yield from self._evaluate(operand, frame)), line)
            case IndexExpression(target, index, line):
                of = yield from self._evaluate(target, frame)
                return element(of, (yield from self._evaluate(index, frame)), line)
            case ListLiteral(items, is_pose):
                return UrscriptList((yield from self._evaluate_all(items, frame)), is_pose=is_pose)
            case _:
                return self._value(expression, frame)

    def _evaluate_all(
        self, expressions: Sequence[Expression], frame: Frame
    ) -> Generator[None, None, list[UrscriptValue]]:
        values: list[UrscriptValue] = []
        for expression in expressions:
            value = yield from self._evaluate(expression, frame)
            values.append(copied(value))
        return values

    def _call(self, call: CallExpression, frame: Frame) -> Evaluation:
        positional = yield from self._evaluate_all(call.arguments, frame)
        values = yield from self._evaluate_all([value for _, value in call.named], frame)
        named = dict(zip([name for name, _ in call.named], values, strict=True))
        if call.function in self._program.functions:
            body = self._function(call, positional, named)
            return self._start_thread(body) if call.is_thread else (yield from body)
        arguments = UrscriptArguments(positional, named)
        if timed := TIMED_FUNCTIONS.get(call.function):
            yield from timed(self._controller, arguments)
            return None
        if function := FUNCTIONS.get(call.function):
            return function(self._controller, arguments)
        raise UrscriptError(f"there is no function `{call.function}`", call.line)

    def _start_thread(self, body: Evaluation) -> int:
        if len(self._threads) >= _MOST_THREADS:
            raise UrscriptError(f"more than {_MOST_THREADS} threads")
        handle = self._next_handle
        self._next_handle += 1
        self._threads[handle] = body
        return handle

    def _function(self, call: CallExpression, positional: Sequence[UrscriptValue], named: Frame) -> Evaluation:
        function = self._program.functions[call.function]
        names = [name for name, _ in function.parameters]
        if len(positional) > len(names) or not named.keys() <= set(names):
            raise UrscriptError(f"`{function.name}` takes {', '.join(names) or 'no arguments'}", call.line)
        local: Frame = {name: copied(value) for name, value in zip(names, positional, strict=False)}
        local |= {name: copied(value) for name, value in named.items()}
        for name, default in function.parameters:
            if name not in local:
                if default is None:
                    raise UrscriptError(f"`{function.name}` lacks its argument `{name}`", call.line)
                local[name] = copied((yield from self._evaluate(default, local)))
        thread = self._current
        depth = self._calls.get(thread, 0) + 1
        if depth > _MOST_CALLS:
            raise UrscriptError(f"more than {_MOST_CALLS} calls in one another", call.line)
        self._calls[thread] = depth
        _, value = yield from self._block(function.body, local)
        self._calls[thread] = depth - 1
        return value
