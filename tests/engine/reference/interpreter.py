"""A reference interpreter of behaviors: recursive, without an event loop, small enough to be believed.

Branches of a concurrency container do not see one another before it ends. So what a node does
follows from where and when it is entered, and from its *deadline*: the instant at which somebody
around it preempts it. What happens at the very instant of the deadline still happens.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, cast

from engine.document import Behavior, Node
from engine.document.parameter import bind_parameters
from tests.engine.reference.scope import Failed, Scope

Line = tuple[Literal["+", "-"], float, str, str, bool]
"""Entered or exited, when, the path, its kind or outcome, and whether it was preempted."""


class TooLong(Exception):
    """The behavior does too much to be worth comparing."""


@dataclass(frozen=True)
class End:
    """How a node ended: with an outcome, for a target straight away, by an error, or preempted."""

    at_s: float
    outcome: str = ""
    straight: bool = False
    failed: bool = False
    preempted: bool = False


@dataclass
class Interpreter:
    """One run of one behavior; `log` tells what happened, branch after branch."""

    behavior: Behavior
    log: list[Line] = field(default_factory=list[Line])
    budget: list[int] = field(default_factory=lambda: [400])

    def run(self, stop_at_s: float) -> tuple[str, str | None, dict[str, object]]:
        """Return status, outcome and userdata of a run that is stopped at an instant."""
        root = Scope(dict(self.behavior.document.userdata))
        end = self.perform(self.behavior.root, "root", root, 0.0, stop_at_s)
        status = "stopped" if end.preempted else "errored" if end.failed else "finished"
        return status, end.outcome if status == "finished" else None, root.values

    def perform(self, node: Node, path: str, scope: Scope, now_s: float, deadline_s: float) -> End:
        """Run a node with its guard, timeout, retry and on_error."""
        self.budget[0] -= 1
        if not self.budget[0]:
            raise TooLong
        end = self._guarded(node, path, scope, now_s, deadline_s)
        assert end.preempted or end.at_s <= deadline_s
        if end.failed and not end.preempted and node.on_error is not None:
            return End(end.at_s, node.on_error, straight=True)
        return end

    def _guarded(self, node: Node, path: str, scope: Scope, now_s: float, deadline_s: float) -> End:
        if node.guard is not None:
            try:
                is_open = scope.evaluate(node.guard.when)
                if not isinstance(is_open, bool):
                    return End(now_s, failed=True)
                if not is_open:
                    return End(now_s, str(node.guard.to), straight=True)
            except Failed:
                return End(now_s, failed=True)
        if node.timeout is None:
            return self._retried(node, path, scope, now_s, deadline_s)
        late_s = now_s + node.timeout.after_s
        end = self._retried(node, path, scope, now_s, min(late_s, deadline_s))
        if not end.preempted:
            return end
        if late_s > deadline_s or end.at_s > deadline_s:
            return End(end.at_s, preempted=True)
        return End(end.at_s, failed=True) if end.failed else End(end.at_s, str(node.timeout.to), straight=True)

    def _retried(self, node: Node, path: str, scope: Scope, now_s: float, deadline_s: float) -> End:
        again = 0
        while True:
            end = self._attempt(node, path, scope, now_s, deadline_s)
            retry = node.retry
            if end.preempted or retry is None or again == retry.times:
                return end
            if not (retry.errors if end.failed else end.outcome in retry.outcomes):
                return end
            now_s = end.at_s + retry.backoff_s * 2**again
            again += 1
            if now_s > deadline_s:
                return End(deadline_s, preempted=True)

    def _attempt(self, node: Node, path: str, scope: Scope, now_s: float, deadline_s: float) -> End:
        work = getattr(self, f"_{node.kind}")
        self.log.append(("+", now_s, path, node.kind, False))
        try:
            end = work(node, path, scope, now_s, deadline_s)
        except Failed:
            end = End(now_s, failed=True)
        self.log.append(("-", end.at_s, path, end.outcome, end.preempted))
        return End(end.at_s, preempted=True, failed=end.failed) if end.preempted else end

    def _state(self, node: Node, path: str, scope: Scope, now_s: float, deadline_s: float) -> End:
        given = cast("dict[str, object]", scope.evaluate(node.parameters))
        source = node.inputs.get("seen", "seen")
        seen = scope.read(source) if scope.has(source) else 0
        if not isinstance(seen, int):
            raise Failed(source)
        end_s = now_s + cast("float", given.get("after_s", 0.0))
        if end_s > deadline_s:
            how = given.get("when_preempted", "rest")
            rest_s = deadline_s + cast("float", given.get("cleanup_s", 0.0))
            return End(rest_s, "c" if how == "refuse" else "", preempted=True, failed=how == "raise")
        ends = str(given.get("ends", "a"))
        if ends == "raise":
            return End(end_s, failed=True)
        if given.get("add"):
            scope.write(node.outputs.get("sum", "sum"), seen + cast("int", given["add"]))
        return End(end_s, ends)

    def _machine(self, node: Node, path: str, scope: Scope, now_s: float, deadline_s: float) -> End:
        assert node.machine is not None
        inner = Scope(dict(node.userdata), scope)
        name = node.machine.initial
        while True:
            child = node.children[name]
            end = self.perform(child, f"{path}/{name}", inner, now_s, deadline_s)
            if end.preempted or end.failed:
                return end
            target = end.outcome if end.straight else child.transitions.get(end.outcome)
            if target is None:
                return End(end.at_s, failed=True)
            if target not in node.children:
                return End(end.at_s, target)
            name, now_s = target, end.at_s

    def _concurrency(self, node: Node, path: str, scope: Scope, now_s: float, deadline_s: float) -> End:
        inner = Scope(dict(node.userdata), scope)
        # What the children would do if nobody decided tells when somebody does; then they do it.
        trial = Interpreter(self.behavior, budget=self.budget)
        alone, scopes = ([Scope({}, inner, walled=True) for _ in node.children] for _ in range(2))
        decided = _decision(node, trial._branches(node, path, alone, now_s, deadline_s), deadline_s)
        ends = self._branches(node, path, scopes, now_s, decided.at_s)
        at_s = max(decided.at_s, *(end.at_s for end in ends.values()))
        if decided.preempted or at_s > deadline_s:
            return End(at_s, preempted=True)
        if decided.failed or any(end.failed for end in ends.values()):
            return End(at_s, failed=True)
        for branch in scopes:
            for key, value in branch.values.items():
                inner.write(key, value)
        return End(at_s, decided.outcome)

    def _branches(self, node: Node, path: str, scopes: list[Scope], now_s: float, deadline_s: float) -> dict[str, End]:
        branches = zip(node.children.items(), scopes, strict=True)
        return {name: self.perform(n, f"{path}/{name}", scope, now_s, deadline_s) for (name, n), scope in branches}

    def _foreach(self, node: Node, path: str, scope: Scope, now_s: float, deadline_s: float) -> End:
        rounds = node.foreach
        assert rounds is not None
        given = scope.evaluate(rounds.items if rounds.times is None else rounds.times)
        if not isinstance(given, list if rounds.times is None else int):
            raise Failed(path)
        items = cast("list[object]", given) if rounds.times is None else list(range(cast("int", given)))
        for number, item in enumerate(items):
            index = {rounds.index: number} if rounds.index is not None else {}
            inner = Scope({**rounds.userdata, rounds.item: item, **index}, scope)
            end = self.perform(rounds.child, f"{path}/child", inner, now_s, deadline_s)
            if end.preempted or end.failed:
                return end
            if end.outcome not in (rounds.next or ("a", "b")):
                return End(end.at_s, "broken")
            now_s = end.at_s
            for key, target in rounds.collect.items():
                if not inner.has(key):
                    return End(now_s, failed=True)
                gathered: object = scope.read(target) if scope.has(target) else list[object]()
                if not isinstance(gathered, list):
                    return End(now_s, failed=True)
                scope.write(target, [*cast("list[object]", gathered), inner.read(key)])
        return End(now_s, "exhausted")

    def _behavior(self, node: Node, path: str, scope: Scope, now_s: float, deadline_s: float) -> End:
        target = self.behavior.references[node.behavior or ""]
        given = cast("Mapping[str, object]", scope.evaluate(node.parameters))
        if any(target.parameters[name].problem(value) for name, value in given.items()):
            raise Failed(path)
        flows_in = {key: scope.read(source) for key, source in node.inputs.items()}
        inner = Scope({**target.document.userdata, **bind_parameters(target.parameters, given), **flows_in})
        beyond = Interpreter(target, self.log, budget=self.budget)
        end = beyond.perform(target.root, f"{path}/root", inner, now_s, deadline_s)
        if end.preempted or end.failed:
            return end
        for key, source in node.outputs.items():
            if not inner.has(key):
                return End(end.at_s, failed=True)
            scope.write(source, inner.read(key))
        return End(end.at_s, end.outcome)


def _decision(node: Node, ends: Mapping[str, End], deadline_s: float) -> End:
    """Return when a concurrency container decides, and for what."""
    assert node.concurrency is not None
    for instant_s in sorted({end.at_s for end in ends.values() if not end.preempted}):
        finished = {n: end for n, end in ends.items() if not end.preempted and end.at_s <= instant_s}
        if any(end.failed for end in finished.values()):
            return End(instant_s, failed=True)
        for rule in node.concurrency.rules:
            ended_so = [name for name, due in rule.when.items() if name in finished and finished[name].outcome == due]
            if len(ended_so) >= (rule.at_least or len(rule.when)):
                return End(instant_s, rule.outcome)
        if len(finished) == len(ends):
            otherwise = node.concurrency.otherwise
            return End(instant_s, otherwise or "", failed=otherwise is None)
    return End(deadline_s, preempted=True)
