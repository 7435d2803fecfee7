"""An operator on the terminal: reads one command per line, and prints what the run asks or waits for."""

from __future__ import annotations

import asyncio
import json
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from types import TracebackType
from typing import Self, cast

from engine.cause_chain import describe_cause
from engine.cli.terminal.line_input import LineInput
from engine.errors import ControlError, FlexcellError
from engine.event import Event
from engine.recording.recorded_run import version_snapshot
from engine.runtime.control import LEVELS, Breakpoint
from engine.runtime.control.single_step import StepMode
from engine.runtime.history.event_texts import event_text
from engine.runtime.plan import Plan
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions
from engine.wording.suggestions import did_you_mean

_MODES: tuple[StepMode, ...] = ("into", "over", "out")
_BEHAVIOR = "behavior"
"""How the scope of the behavior itself is called."""
_RESTING = frozenset({"gate", "pause_confirmed", "run_ended"})
"""The tags of the events after which a run may rest."""
_PRINTED = frozenset({"outcome_requested", "gate", "pause_confirmed", "stepped_back", "operator"})
"""The tags of the events that are printed for the operator."""


@dataclass(frozen=True)
class _Command:
    """One command of the operator."""

    usage: str
    meaning: str
    do: Callable[[OperatorConsole, Sequence[str]], None]


class _UsageError(Exception):
    """The arguments of a command are invalid."""


class OperatorConsole:
    """The operator of one run while the context is entered; at the end of input the operator is lost.

    Args:
        run: The run, not yet executing.
        say: Prints a line for the operator.
        reload: Reloads the behavior, for a hot change.
        policy: Defines what the run does when the input ends.
        descriptor: File from which commands are read; standard input by default.
    """

    def __init__(
        self,
        run: Run,
        *,
        say: Callable[[str], None],
        reload: Callable[[], Plan],
        policy: RunOptions,
        descriptor: int | None = None,
    ) -> None:
        self.run = run
        self.say = say
        self._reload = reload
        self._policy = policy
        known = descriptor if descriptor is not None else _standard_input()
        self._input = LineInput(known, line=self.execute_line, end=self._on_input_end)
        self._waiting: asyncio.Task[None] | None = None
        self._stepping_back: asyncio.Task[None] | None = None
        self._settled = asyncio.Event()

    def __enter__(self) -> Self:
        self.run.watch(self._show)
        self.run.control.attach_operator()
        self._input.open()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._input.close()
        self.run.recorder.unwatch(self._show)
        for task in (self._waiting, self._stepping_back):
            if task is not None:
                task.cancel()

    def execute_line(self, line: str) -> None:
        """Execute the command in a line, or print in one line why it cannot be executed."""
        words = line.split()
        if not words or self.run.ended:
            return
        command = COMMANDS.get(words[0])
        if command is None:
            self.say(f"there is no command {words[0]!r} ({did_you_mean(words[0], COMMANDS)}; `help` lists them)")
            return
        try:
            command.do(self, words[1:])
        except _UsageError as error:
            self.say(f"{error}; usage: {command.usage}")
        except FlexcellError as error:
            self.say(str(error))

    def reload(self, *, preempt: bool) -> None:
        """Replace the running behavior with the current content of its file."""
        plan = self._reload()
        report = self.run.change(plan, preempt=preempt, kept=version_snapshot(plan.source))
        for change in report.changes or ("nothing, the behavior is the same",):
            self.say(f"changed: {change}")

    def back(self, path: str) -> None:
        """Undo the last step, in the branch of `path` if one is given; read no further line until it is undone."""
        self._input.hold()
        self._stepping_back = asyncio.get_running_loop().create_task(self._go_back(path), name="operator steps back")

    async def _go_back(self, path: str) -> None:
        try:
            undone = await self.run.step_back(path)
            self.say(f"undoing {', '.join(undone)}" if undone else "stepped back, nothing to undo")
        except FlexcellError as error:
            self.say(str(error))
        finally:
            self._input.release()

    def wait(self) -> None:
        """Read no further line until the run is at rest: paused and confirmed, locked, or asking."""
        self._input.hold()
        self._waiting = asyncio.get_running_loop().create_task(self._until_rest(), name="operator waits")

    async def _until_rest(self) -> None:
        while not self.run.ended:
            self._settled.clear()
            # A node that was just released must not count as resting.
            await self.run.control.settled()
            if self._at_rest():
                break
            await self._settled.wait()
        self._input.release()

    def _at_rest(self) -> bool:
        view = self.run.control.view()
        held = any({"lock", "autonomy"} & set(each.reasons) for each in view.waiting)
        return held or (view.paused and view.confirmed)

    def _show(self, event: Event) -> None:
        tag = event.__struct_config__.tag
        if tag in _RESTING:
            self._settled.set()
        if tag not in _PRINTED:
            return
        shown = event_text(event)
        path, cause = shown.path, shown.cause
        line = f"{path} {shown.text}" if path else shown.text
        if tag == "outcome_requested":
            line = f"? {line}: answer {path} | force {path} OUTCOME | repeat {path}"
        elif cause is not None:
            line = f"{line}: {describe_cause(cause)}"
        elif tag == "operator" and shown.level == "warning":
            actions = {"hold": "the run pauses", "continue": "the run continues", "stop": "the run stops"}
            line = f"the input ended, {line}: {actions[self._policy.loss_policy]}"
        elif tag == "operator":
            return
        self.say(line)

    def _on_input_end(self) -> None:
        if self.run.ended:
            return
        if self._policy.loss_policy == "continue":
            self.run.control.detach_operator()
        else:
            self.run.control.lose_operator()


def _standard_input() -> int | None:
    with suppress(AttributeError, OSError, ValueError):
        return sys.stdin.fileno()
    return None  # closed, or replaced by an object that is not a file


def _one(words: Sequence[str], what: str) -> str:
    if len(words) != 1:
        raise _UsageError(f"one {what} is required" if not words else f"unexpected {' '.join(words[1:])!r}")
    return words[0]


def _none(words: Sequence[str]) -> None:
    if words:
        raise _UsageError(f"unexpected {' '.join(words)!r}")


def _pause(console: OperatorConsole, words: Sequence[str]) -> None:
    _none(words)
    console.run.control.pause()


def _resume(console: OperatorConsole, words: Sequence[str]) -> None:
    _none(words)
    console.run.control.resume()


def _step(console: OperatorConsole, words: Sequence[str]) -> None:
    left = list(words)
    mode: StepMode = cast("StepMode", left.pop(0)) if left and left[0] in _MODES else "into"
    console.run.control.step(mode, _one(left, "path") if left else "")


def _back(console: OperatorConsole, words: Sequence[str]) -> None:
    console.back(_one(words, "path") if words else "")


def _lock(console: OperatorConsole, words: Sequence[str]) -> None:
    console.run.control.lock(_one(words, "path"))


def _unlock(console: OperatorConsole, words: Sequence[str]) -> None:
    console.run.control.unlock(_one(words, "path"))


def _force(console: OperatorConsole, words: Sequence[str]) -> None:
    if len(words) != 2:
        raise _UsageError("a path and an outcome are required")
    console.run.control.force(words[0], words[1])


def _repeat(console: OperatorConsole, words: Sequence[str]) -> None:
    console.run.control.repeat(_one(words, "path"))


def _answer(console: OperatorConsole, words: Sequence[str]) -> None:
    control = console.run.control
    asking = [each.path for each in control.view().waiting if "autonomy" in each.reasons]
    if not words and len(asking) != 1:
        raise ControlError("no question is open" if not asking else f"several questions are open: {', '.join(asking)}")
    control.answer(_one(words, "path") if words else asking[0])


def _autonomy(console: OperatorConsole, words: Sequence[str]) -> None:
    level = _one(words, "level")
    if level not in LEVELS:
        raise _UsageError(f"{level!r} is not one of {', '.join(LEVELS)}")
    console.run.control.set_autonomy(level)


def _set(console: OperatorConsole, words: Sequence[str]) -> None:
    control = console.run.control
    scoped = len(words) > 3 and words[-2] == "in"
    text = " ".join(words[1:-2] if scoped else words[1:])
    try:
        value = json.loads(text)
    except ValueError:
        raise _UsageError(
            f"a key and a value as JSON are required, as in `set {words[0] if words else 'n'} 3`"
        ) from None
    if scoped:
        scope = "" if words[-1] == _BEHAVIOR else words[-1]
    else:
        scopes = control.scopes_with(words[0])
        if len(scopes) > 1:
            places = ", ".join(each or _BEHAVIOR for each in scopes)
            raise ControlError(f"several containers have a key {words[0]!r}: {places}", hint="add `in CONTAINER`")
        scope = next(iter(scopes), "")
    control.set_userdata(scope, words[0], value)


def _break(console: OperatorConsole, words: Sequence[str]) -> None:
    control = console.run.control
    if not words:
        for each in control.view().breakpoints or ("there are no breakpoints",):
            console.say(_breakpoint_text(each) if isinstance(each, Breakpoint) else each)
        return
    control.set_breakpoints((*control.view().breakpoints, _breakpoint(words)))


def _clear(console: OperatorConsole, words: Sequence[str]) -> None:
    control = console.run.control
    known = control.view().breakpoints
    path = _one(words, "path") if words else ""
    if path and all(each.path != path for each in known):
        raise ControlError("there is no breakpoint", where=path, hint=did_you_mean(path, [each.path for each in known]))
    control.set_breakpoints([each for each in known if path and each.path != path])


def _breakpoint(words: Sequence[str]) -> Breakpoint:
    """Read `PATH [after] [hits N] [if EXPR]`, where the expression extends to the end or to a final `hits N`."""
    path, *left = words
    when, hits, condition = "before", 1, None
    if len(left) >= 2 and left[-2] == "hits":
        hits, left = _count(left[-1]), left[:-2]
    while left:
        word = left.pop(0)
        if word in ("before", "after"):
            when = word
        elif word == "hits" and left:
            hits = _count(left.pop(0))
        elif word == "if" and left:
            condition, left = " ".join(left), []
        else:
            raise _UsageError(f"unexpected {word!r}")
    breakpoint_ = Breakpoint(path=path, when="after" if when == "after" else "before", condition=condition, hits=hits)
    _ = breakpoint_.template  # compiled now, so that an invalid expression is rejected here
    return breakpoint_


def _count(word: str) -> int:
    if not word.isdecimal() or int(word) < 1:
        raise _UsageError(f"{word!r} is not a positive integer")
    return int(word)


def _breakpoint_text(each: Breakpoint) -> str:
    condition = f" if {each.condition}" if each.condition is not None else ""
    hits = f" hits {each.hits}" if each.hits > 1 else ""
    return f"break {each.path} {each.when}{condition}{hits}"


def _reload(console: OperatorConsole, words: Sequence[str]) -> None:
    if words not in ([], ["preempt"]):
        raise _UsageError(f"unexpected {' '.join(words)!r}")
    console.reload(preempt=bool(words))


def _where(console: OperatorConsole, words: Sequence[str]) -> None:
    _none(words)
    view = console.run.control.view()
    paused = ("paused" if view.confirmed else "pausing") if view.paused else "running"
    console.say(f"{paused}, autonomy {view.autonomy}, operator {view.operator}")
    waiting = {each.path for each in view.waiting}
    for path in console.run.active_states:
        if path not in waiting:
            console.say(f"  in {path}")
    for each in view.waiting:
        outcome = f" with {each.outcome}" if each.outcome else ""
        console.say(f"  {each.point} {each.path}{outcome}: {', '.join(each.reasons)}")
    for path in view.locks:
        console.say(f"  lock {path}")
    for each in view.breakpoints:
        console.say(f"  {_breakpoint_text(each)}")


def _wait(console: OperatorConsole, words: Sequence[str]) -> None:
    _none(words)
    console.wait()


def _stop(console: OperatorConsole, words: Sequence[str]) -> None:
    console.run.stop(" ".join(words) or "stopped by the operator")


def _detach(console: OperatorConsole, words: Sequence[str]) -> None:
    _none(words)
    console.run.control.detach_operator()


def _help(console: OperatorConsole, _words: Sequence[str]) -> None:
    for command in COMMANDS.values():
        console.say(f"  {command.usage:44}{command.meaning}")


COMMANDS: Mapping[str, _Command] = {
    "pause": _Command("pause", "pause the run", _pause),
    "resume": _Command("resume", "resume the paused run", _resume),
    "step": _Command("step [into|over|out] [PATH]", "execute one step of a paused run", _step),
    "back": _Command("back [PATH]", "undo the last step of a paused run", _back),
    "break": _Command("break [PATH [after] [if EXPR] [hits N]]", "set a breakpoint; without PATH: list them", _break),
    "clear": _Command("clear [PATH]", "remove breakpoints", _clear),
    "lock": _Command("lock PATH", "hold the outcome of a node", _lock),
    "unlock": _Command("unlock PATH", "release the outcome of a node", _unlock),
    "force": _Command("force PATH OUTCOME", "end a node with this outcome", _force),
    "repeat": _Command("repeat PATH", "run a node again", _repeat),
    "answer": _Command("answer [PATH]", "accept a requested outcome", _answer),
    "set": _Command("set KEY JSON [in CONTAINER]", "replace a value of the userdata of a paused run", _set),
    "autonomy": _Command("autonomy off|low|high|full", "outcomes that pass without a question", _autonomy),
    "reload": _Command("reload [preempt]", "continue with the current file", _reload),
    "where": _Command("where", "show the state of the run", _where),
    "wait": _Command("wait", "read no further line until the run is at rest or asks", _wait),
    "detach": _Command("detach", "continue the run without operator", _detach),
    "stop": _Command("stop [REASON]", "stop the run", _stop),
    "help": _Command("help", "list the commands", _help),
}
