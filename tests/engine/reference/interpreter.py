"""A reference interpreter of behaviors: without an event loop, small enough to be believed.

Each branch of a concurrency container is a task of `schedule.Schedule`, everything else a call inside of one. What
happens at the very instant of a timeout still happens.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Literal, cast

from engine.document import Behavior, NodeSpec
from engine.document.nodes.concurrency_condition import ConcurrencyCondition
from engine.document.parameter_spec import bind_parameters
from tests.engine.reference.schedule import Children, Deadline, End, Preempted, Schedule, Sleep, Steps, Task
from tests.engine.reference.scope import Failed, Scope

Line = tuple[Literal["+", "-"], float, str, str, bool]
"""Entered or exited, when, the path, its kind or outcome, and whether it was preempted."""


class TooLong(Exception):
    """The behavior does too much to be worth comparing."""


@dataclass
class Interpreter:
    """One run of one behavior; `log` tells what happened, in order."""

    behavior: Behavior
    log: list[Line] = field(default_factory=list[Line])
    budget: list[int] = field(default_factory=lambda: [400])
    schedule: Schedule = field(default_factory=Schedule)

    def run(self, stop_at_s: float) -> tuple[str, str | None, dict[str, object]]:
        """Return status, outcome and userdata of a run that is stopped at an instant."""
        root = Scope(dict(self.behavior.document.userdata))
        end = self.schedule.run(self.perform(self.behavior.root, "root", root), stop_at_s)
        status = "stopped" if end.preempted else "errored" if end.failed else "finished"
        return status, end.outcome if status == "finished" else None, root.values

    @property
    def _now_s(self) -> float:
        return self.schedule.now_s

    @property
    def _task(self) -> Task:
        assert self.schedule.current is not None
        return self.schedule.current

    def perform(self, node: NodeSpec, path: str, scope: Scope) -> Steps:
        """Run a node with its guard, timeout, retry and on_error."""
        self.budget[0] -= 1
        if not self.budget[0]:
            raise TooLong
        if node.is_disabled:
            return End(self._now_s, node.passes_with)
        end = yield from self._guarded(node, path, scope)
        if end.failed and not end.preempted and node.on_error is not None:
            return End(end.at_s, node.on_error, straight=True)
        return end

    def _guarded(self, node: NodeSpec, path: str, scope: Scope) -> Steps:
        if node.guard is not None:
            try:
                is_open = scope.evaluate(node.guard.when)
                if not isinstance(is_open, bool):
                    return End(self._now_s, failed=True)
                if not is_open:
                    return End(self._now_s, str(node.guard.to), straight=True)
            except Failed:
                return End(self._now_s, failed=True)
        if node.timeout is None:
            return (yield from self._retried(node, path, scope))
        task, depth = self._task, path.count("/")
        timer = Deadline(self._now_s + node.timeout.after_s, depth, task)
        self.schedule.deadlines.append(timer)
        end = yield from self._retried(node, path, scope)
        if timer in self.schedule.deadlines:
            self.schedule.deadlines.remove(timer)
        if not end.preempted:
            return end
        if min(task.asked) != depth:
            # Something around it asks too.
            return End(end.at_s, preempted=True, failed=end.failed)
        task.asked.clear()
        return End(end.at_s, failed=True) if end.failed else End(end.at_s, str(node.timeout.to), straight=True)

    def _retried(self, node: NodeSpec, path: str, scope: Scope) -> Steps:
        again = 0
        while True:
            end = yield from self._attempt(node, path, scope)
            retry = node.retry
            if end.preempted or retry is None or again == retry.times:
                return end
            if not (retry.errors if end.failed else end.outcome in retry.outcomes):
                return end
            backoff_s = retry.backoff_s * 2**again
            again += 1
            try:
                if backoff_s:
                    yield Sleep(self._now_s + backoff_s)
            except Preempted:
                return End(self._now_s, preempted=True)

    def _attempt(self, node: NodeSpec, path: str, scope: Scope) -> Steps:
        work: Callable[[NodeSpec, str, Scope], Steps] = getattr(self, f"_{node.kind}")
        self.log.append(("+", self._now_s, path, node.kind, False))
        try:
            end = yield from work(node, path, scope)
        except Failed:
            end = End(self._now_s, failed=True)
        self.log.append(("-", end.at_s, path, end.outcome, end.preempted))
        return End(end.at_s, preempted=True, failed=end.failed) if end.preempted else end

    def _state(self, node: NodeSpec, path: str, scope: Scope) -> Steps:
        given = cast("dict[str, object]", scope.evaluate(node.parameters))
        source = node.inputs.get("seen", "seen")
        seen = scope.read(source) if scope.has(source) else 0
        if not isinstance(seen, int):
            raise Failed(source)
        try:
            if after_s := cast("float", given.get("after_s", 0.0)):
                yield Sleep(self._now_s + after_s)
        except Preempted:
            if cleanup_s := cast("float", given.get("cleanup_s", 0.0)):
                yield Sleep(self._now_s + cleanup_s, cleans_up=True)
            how = given.get("when_preempted", "rest")
            return End(self._now_s, "c" if how == "refuse" else "", preempted=True, failed=how == "raise")
        ends = str(given.get("ends", "a"))
        if ends == "raise":
            return End(self._now_s, failed=True)
        if given.get("add"):
            scope.write(node.outputs.get("sum", "sum"), seen + cast("int", given["add"]))
        return End(self._now_s, ends)

    def _machine(self, node: NodeSpec, path: str, scope: Scope) -> Steps:
        assert node.machine is not None
        inner = Scope(dict(node.userdata), scope)
        name = node.machine.initial
        while True:
            child = node.children[name]
            end = yield from self.perform(child, f"{path}/{name}", inner)
            if end.preempted or end.failed:
                return end
            target = end.outcome if end.straight else child.transitions.get(end.outcome)
            if target is None:
                return End(end.at_s, failed=True)
            if target not in node.children:
                return End(end.at_s, target)
            name = target

    def _concurrency(self, node: NodeSpec, path: str, scope: Scope) -> Steps:
        assert node.concurrency is not None
        inner = Scope(dict(node.userdata), scope)
        shared = frozenset(node.concurrency.shared)
        scopes = {name: Scope({}, inner, walled=True, shared=shared) for name in node.children}
        own, depth = self._task, path.count("/")
        tasks = {
            name: Task((*own.order, rank), self.perform(child, f"{path}/{name}", scopes[name]))
            for rank, (name, child) in enumerate(node.children.items())
        }
        own.seen = 0
        for task in tasks.values():
            self.schedule.add(task)
        decided = yield from self._decided(node, path, tasks)
        for task in tasks.values():
            if task.end is None:
                self.schedule.preempt(task, depth)
        while any(task.end is None for task in tasks.values()):
            try:
                yield Children(path, tuple(tasks.values()), all_of_them=True)
            except Preempted:
                decided = End(self._now_s, preempted=True)
        failed = decided.failed or any(task.end.failed for task in tasks.values() if task.end is not None)
        if decided.preempted or own.asked:
            return End(self._now_s, preempted=True, failed=failed)
        if failed:
            return End(self._now_s, failed=True)
        for branch in scopes.values():
            for key, value in branch.values.items():
                inner.write(key, value)
        return End(self._now_s, decided.outcome)

    def _decided(self, node: NodeSpec, path: str, tasks: Mapping[str, Task]) -> Steps:
        fired: set[int] = set()
        while True:
            try:
                yield Children(path, tuple(tasks.values()))
            except Preempted:
                return End(self._now_s, preempted=True)
            end = _decision(node, {name: task.end for name, task in tasks.items() if task.end is not None})
            if end is not None:
                return End(self._now_s, end.outcome, failed=end.failed)
            self._preempt_some(node, path, tasks, fired)

    def _preempt_some(self, node: NodeSpec, path: str, tasks: Mapping[str, Task], fired: set[int]) -> None:
        """End the branches that conditions name which hold for the first time, first in the document first."""
        assert node.concurrency is not None
        finished = {name: task.end for name, task in tasks.items() if task.end is not None}
        ending: set[str] = set()
        for index, rule in enumerate(node.concurrency.rules):
            if rule.preempt and index not in fired and _holds(rule, finished):
                fired.add(index)
                ending.update(rule.preempt)
        for name, task in tasks.items():
            if name in ending and task.end is None:
                self.schedule.preempt(task, path.count("/"))

    def _foreach(self, node: NodeSpec, path: str, scope: Scope) -> Steps:
        rounds = node.foreach
        assert rounds is not None
        given = scope.evaluate(rounds.items if rounds.times is None else rounds.times)
        if not isinstance(given, list if rounds.times is None else int):
            raise Failed(path)
        items = cast("list[object]", given) if rounds.times is None else list(range(cast("int", given)))
        for number, item in enumerate(items):
            index = {rounds.index: number} if rounds.index is not None else {}
            inner = Scope({**rounds.userdata, rounds.item: item, **index}, scope)
            end = yield from self.perform(rounds.child, f"{path}/child", inner)
            if end.preempted or end.failed:
                return end
            if end.outcome not in (rounds.next or ("a", "b")):
                return End(end.at_s, "broken")
            for key, target in rounds.collect.items():
                if not inner.has(key):
                    return End(self._now_s, failed=True)
                gathered: object = scope.read(target) if scope.has(target) else list[object]()
                if not isinstance(gathered, list):
                    return End(self._now_s, failed=True)
                scope.write(target, [*cast("list[object]", gathered), inner.read(key)])
        return End(self._now_s, "exhausted")

    def _behavior(self, node: NodeSpec, path: str, scope: Scope) -> Steps:
        target = self.behavior.references[node.behavior or ""]
        given = cast("Mapping[str, object]", scope.evaluate(node.parameters))
        if any(target.parameters[name].problem(value) for name, value in given.items()):
            raise Failed(path)
        flows_in = {key: scope.read(source) for key, source in node.inputs.items()}
        inner = Scope({**target.document.userdata, **bind_parameters(target.parameters, given), **flows_in})
        beyond = Interpreter(target, self.log, self.budget, self.schedule)
        end = yield from beyond.perform(target.root, f"{path}/root", inner)
        if end.preempted or end.failed:
            return end
        for key, source in node.outputs.items():
            if not inner.has(key):
                return End(end.at_s, failed=True)
            scope.write(source, inner.read(key))
        return End(end.at_s, end.outcome)


def _decision(node: NodeSpec, finished: Mapping[str, End]) -> End | None:
    """Return for what a concurrency container decides; None where it waits for more."""
    assert node.concurrency is not None
    if any(end.failed for end in finished.values()):
        return End(0.0, failed=True)
    for rule in node.concurrency.rules:
        if not rule.preempt and _holds(rule, finished):
            return End(0.0, rule.outcome)
    if len(finished) == len(node.children):
        otherwise = node.concurrency.otherwise
        return End(0.0, otherwise or "", failed=otherwise is None)
    return None


def _holds(rule: ConcurrencyCondition, finished: Mapping[str, End]) -> bool:
    ended_so = [name for name, due in rule.when.items() if name in finished and finished[name].outcome == due]
    return len(ended_so) >= (rule.at_least or len(rule.when))
