"""The state machine container: one child at a time, transitions from outcome to target."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

from engine.errors import StateError
from engine.event import TransitionTaken
from engine.runtime.nodes.diagnosis import Diagnosis
from engine.runtime.nodes.execution import Execution
from engine.runtime.nodes.livelock_detector import LivelockDetector
from engine.runtime.nodes.node import Node
from engine.runtime.nodes.node_entry import NodeEntry, WithoutEntry
from engine.runtime.record.node_exit import NodeExit
from engine.runtime.scheduling.wait_counters import BusyLoopCounter
from engine.runtime.userdata.userdata import Scope
from engine.state import Outcome
from engine.wording.suggestions import did_you_mean


@dataclass(frozen=True, kw_only=True)
class Machine(WithoutEntry):
    """Children by name in document order; `initial` runs first."""

    initial: str
    children: Mapping[str, Node]
    userdata: Mapping[str, object] = field(default_factory=dict[str, object])
    kind: str = "machine"
    """The key of this container in documents."""

    @cached_property
    def outcomes(self) -> tuple[str, ...]:
        """The transition targets that are not children."""
        leading = [target for child in self.children.values() for target in child.targets]
        return tuple(dict.fromkeys(target for target in leading if target not in self.children))

    @cached_property
    def nominal(self) -> frozenset[str]:
        """Outcomes reached from the initial child while every child ends nominally."""
        reached: set[str] = set()
        due = [self.initial]
        while due:
            name = due.pop()
            if name in reached:
                continue
            reached.add(name)
            child = self.children.get(name)
            if child is not None:
                due += [t for outcome, t in child.transitions.items() if outcome in child.work.nominal]
                due += [child.guard.target] if child.guard is not None else []
        return frozenset(reached - set(self.children))

    def initial_values(self, inputs: Mapping[str, object]) -> Mapping[str, object]:
        """Return the initial values of its scope."""
        return self.userdata

    async def run(self, entry: NodeEntry, path: str, visit: int, scope: Scope, execution: Execution) -> Outcome:
        """Run children until a transition names an outcome of this machine."""
        point = entry.point
        inner = execution.scopes.open(path, point.values if point is not None else self.userdata, scope)
        name = point.current if point is not None and point.current is not None else self.initial
        diagnosis = Diagnosis(point.cause, point.reason) if point is not None else Diagnosis()
        if name not in self.children:
            return diagnosis.outcome(name, self.nominal)
        busy_steps = BusyLoopCounter(path, execution.waits, execution.clock)
        livelock = LivelockDetector(path, execution) if execution.clock.virtual else None
        machine = self
        recorder = execution.recorder
        while True:
            child = machine.children[name]
            left = await child.perform(inner, execution)
            if execution.replaced:
                # After a hot change the transitions of the new version apply.
                machine = execution.latest(f"{path}/", machine)
                child = machine.children[name]
            if left.back:
                name, diagnosis = left.target or name, Diagnosis(left.cause, left.reason)
                continue
            diagnosis.take(child, left)
            target = child.transitions.get(left.outcome) if left.target is None else left.target
            if target is None:
                raise machine._no_transition(child, left)
            if recorder.heard:
                seq, time_s = recorder.stamp()
                recorder.record(
                    TransitionTaken(seq, time_s, path=path, source=name, outcome=left.outcome, target=target)
                )
            else:
                recorder.count()
            if target not in machine.children:
                return diagnosis.outcome(target, machine.nominal)
            if busy_steps.step(most=execution.instant_limit):
                await asyncio.sleep(0)
                if busy_steps.count >= execution.instant_limit:
                    problem = f"{busy_steps.count} transitions in a row without waiting for anything"
                    raise machine._endless(path, target, problem, "let one of these states wait for something")
            if livelock is not None and (passed_s := livelock.step()) is not None:
                problem = f"this loop has only waited for {passed_s:g} s, and nothing can end it"
                raise machine._endless(path, target, problem, "wait for the expected event, with a timeout")
            name = target

    def _no_transition(self, child: Node, left: NodeExit) -> StateError:
        return StateError(
            f"outcome {left.outcome!r} has no transition",
            where=child.position or child.path,
            hint=f"add it to `transitions`; {did_you_mean(left.outcome, child.transitions)}",
        )

    def _endless(self, path: str, name: str, problem: str, hint: str) -> StateError:
        """Return the error of an endless loop, naming the states along its transitions."""
        loop = [name]
        while True:
            targets = [t for t in self.children[loop[-1]].transitions.values() if t in self.children]
            if not targets or targets[0] in loop:
                break
            loop.append(targets[0])
        return StateError(
            f"{problem}, through {' → '.join(loop)}",
            where=path,
            hint=f"{hint}, or leave the loop",
        )
