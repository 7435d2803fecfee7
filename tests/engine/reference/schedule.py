"""Virtual time for the reference interpreter: tasks take turns by time and document order, then containers decide.

A task is a generator that yields what it waits for. At each instant every task that can go on does so, first in the
document first; when none can, the deepest container or timeout that has something to decide does, and what follows
from it happens before the next one.
"""

from __future__ import annotations

import math
import random
from collections.abc import Generator
from dataclasses import dataclass, field

Order = tuple[int, ...]
"""Where a branch stands in the document: its number in each container around it."""


class Preempted(Exception):
    """Thrown into a task where it waits, once, however many ask for it."""


@dataclass(frozen=True)
class End:
    """How a node ended: with an outcome, for a target straight away, by an error, or preempted."""

    at_s: float
    outcome: str = ""
    straight: bool = False
    failed: bool = False
    preempted: bool = False


@dataclass(frozen=True)
class Sleep:
    """Until an instant; a clean-up is not preempted again."""

    until_s: float
    cleans_up: bool = False


@dataclass(frozen=True)
class Children:
    """Until branches have ended: some of them, to be looked at when all of the instant has happened, or all."""

    path: str
    tasks: tuple[Task, ...]
    all_of_them: bool = False


Steps = Generator[Sleep | Children, None, End]


@dataclass(eq=False)
class Task:
    """A branch; `asked` are the depths of the nodes that have it preempted from there inward."""

    order: Order
    steps: Steps
    waits: Sleep | Children | None = None
    end: End | None = None
    seen: int = 0
    asked: list[int] = field(default_factory=list[int])


@dataclass(eq=False)
class Deadline:
    """A timeout that runs: at its instant, what is inside of the node at `depth` of the task is preempted."""

    at_s: float
    depth: int
    task: Task


class Schedule:
    """All tasks of a run, and the time; with `chance`, tasks of one instant take turns in any order."""

    def __init__(self, chance: random.Random | None = None) -> None:
        self._chance = chance
        self.now_s = 0.0
        self.deadlines: list[Deadline] = []
        self.current: Task | None = None
        self._tasks: list[Task] = []

    def add(self, task: Task) -> Task:
        """Let a task begin in its turn."""
        self._tasks.append(task)
        return task

    def run(self, steps: Steps, stop_at_s: float) -> End:
        """Run a task, and those that it adds, to its end; it is preempted at an instant."""
        root = self.add(Task((), steps))
        self.deadlines.append(Deadline(stop_at_s, -1, root))
        while root.end is None:
            ready = [task for task in self._tasks if self._can_go_on(task)]
            if ready:
                self._step(self._chance.choice(ready) if self._chance else min(ready, key=lambda task: task.order))
            elif not self._decides():
                self.now_s = self._next_s()
        return root.end

    def preempt(self, task: Task, depth: int) -> None:
        """Have a task end what is inside of a depth; one that has begun to clean up goes on with that."""
        task.asked.append(depth)
        cleans_up = isinstance(task.waits, Sleep) and task.waits.cleans_up
        if task.end is None and len(task.asked) == 1 and not cleans_up:
            self._step(task, preempted=True)

    def _can_go_on(self, task: Task) -> bool:
        match task.waits:
            case None:
                return True
            case Sleep(until_s=until_s):
                return until_s <= self.now_s
            case Children(tasks=tasks, all_of_them=all_of_them):
                return all_of_them and all(each.end is not None for each in tasks)

    def _step(self, task: Task, *, preempted: bool = False) -> None:
        before, self.current = self.current, task
        try:
            task.waits = task.steps.throw(Preempted()) if preempted else next(task.steps)
        except StopIteration as done:
            task.end = done.value
            self._tasks.remove(task)
        finally:
            self.current = before

    def _decides(self) -> bool:
        """Let the deepest container with news decide, or the deepest timeout that is due; false where there is none."""
        due: list[tuple[int, int, Order, Task, Deadline | None]] = []
        for task in self._tasks:
            if isinstance(task.waits, Children) and not task.waits.all_of_them:
                ended = sum(each.end is not None for each in task.waits.tasks)
                if ended > task.seen:
                    due.append((-task.waits.path.count("/"), 0, task.order, task, None))
        due += [
            (-timer.depth, 1, timer.task.order, timer.task, timer)
            for timer in self.deadlines
            if timer.at_s <= self.now_s
        ]
        if not due:
            return False
        *_, task, timer = min(due, key=lambda each: each[:3])
        if timer is not None:
            self.deadlines.remove(timer)
            self.preempt(task, timer.depth)
        else:
            assert isinstance(task.waits, Children)
            task.seen = sum(each.end is not None for each in task.waits.tasks)
            self._step(task)
        return True

    def _next_s(self) -> float:
        sleeping = (task.waits.until_s for task in self._tasks if isinstance(task.waits, Sleep))
        return min((*sleeping, *(timer.at_s for timer in self.deadlines)), default=math.inf)
