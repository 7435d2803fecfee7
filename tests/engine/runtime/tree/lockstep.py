"""The reference for trees: plain py_trees with scripted behaviours, ticked at every instant at which something ends."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import py_trees.decorators
from py_trees import composites, decorators
from py_trees.behaviour import Behaviour
from py_trees.common import OneShotPolicy, ParallelPolicy, Status

from tests.engine.runtime.tree.course import Course
from tests.engine.runtime.tree.specimen import EVERY_S, Leaf, Specimen

REMAPS = {
    ("failure", "running"): decorators.FailureIsRunning,
    ("failure", "success"): decorators.FailureIsSuccess,
    ("success", "failure"): decorators.SuccessIsFailure,
    ("success", "running"): decorators.SuccessIsRunning,
    ("running", "failure"): decorators.RunningIsFailure,
    ("running", "success"): decorators.RunningIsSuccess,
}
HIDING = (decorators.Condition, decorators.FailureIsRunning, decorators.SuccessIsRunning)
STATUS = {"success": Status.SUCCESS, "failure": Status.FAILURE, "running": Status.RUNNING}


@dataclass
class World:
    """The time, and what was begun when."""

    now_s: float = 0.0
    begun: list[tuple[float, str]] = field(default_factory=list[tuple[float, str]])
    pending: list[Scripted] = field(default_factory=list["Scripted"])
    calls: int = 0

    def monotonic(self) -> float:
        """Stand in for `time.monotonic`, which never gives the same twice."""
        self.calls += 1
        return self.now_s + self.calls * 1e-9


class Scripted(Behaviour):
    """One leaf; a commanding one is RUNNING in its first tick, and begins when that is over."""

    def __init__(self, name: str, leaf: Leaf, world: World) -> None:
        super().__init__(name)
        self.leaf = leaf
        self.world = world
        self.count = 0
        self.ends_s = 0.0
        self.fresh = False

    def initialise(self) -> None:
        self.fresh = self.leaf.commands
        if self.leaf.commands:
            self.world.pending.append(self)
        else:
            self.begin()

    def begin(self) -> None:
        script = self.leaf.script
        self.count += 1
        self.ends_s = self.world.now_s + script[min(self.count, len(script)) - 1][0]
        self.world.begun.append((self.world.now_s, self.name))

    def update(self) -> Status:
        if self.fresh or self.world.now_s < self.ends_s:
            self.fresh = False
            return Status.RUNNING
        good = self.leaf.script[min(self.count, len(self.leaf.script)) - 1][1]
        return Status.SUCCESS if good else Status.FAILURE

    def terminate(self, new_status: Status) -> None:
        if self in self.world.pending:
            self.world.pending.remove(self)


class Branching(composites.Composite):
    """IfThenElseNode and WhileDoElseNode of BehaviorTree.CPP 4, `tick` by `tick` as they are written there."""

    def __init__(self, name: str, children: list[Behaviour], *, reactive: bool) -> None:
        super().__init__(name, children)
        self.reactive = reactive
        self.child_idx = 0

    def tick(self) -> Iterator[Behaviour]:
        if self.status is not Status.RUNNING:
            self.stop(Status.INVALID)
            self.child_idx = 0
        if self.reactive or self.child_idx == 0:
            condition = self.children[0]
            yield from condition.tick()
            if condition.status is Status.RUNNING:
                self.status = Status.RUNNING
                yield self
                return
            self.child_idx = 1 if condition.status is Status.SUCCESS else 2
            other = 3 - self.child_idx
            if self.reactive and other < len(self.children):
                self.children[other].stop(Status.INVALID)
        status = Status.FAILURE
        if self.child_idx < len(self.children):
            yield from self.children[self.child_idx].tick()
            status = self.children[self.child_idx].status
        if status is not Status.RUNNING:
            for child in self.children:
                child.stop(Status.INVALID)
            self.stop(status)
        self.status = status
        yield self


def run_lockstep(specimen: Specimen, *, until_s: float, instant_limit: int) -> Course:
    """Tick a plain py_trees tree in step with its scripts."""
    world = World()
    root = _built(specimen, "", world)
    instants = number = 0
    ticked: dict[Behaviour, tuple[int, float]] = {}
    woken: set[tuple[Behaviour, float]] = set()
    module: Any = py_trees.decorators
    real_time, module.time = module.time, world
    try:
        while world.now_s < until_s:
            number += 1
            for node in root.tick():
                ticked[node] = number, world.now_s
            for leaf in world.pending:
                leaf.begin()
            world.pending.clear()
            if root.status is not Status.RUNNING:
                return Course(root.status.value.lower(), world.now_s, tuple(world.begun))
            reasons = [(key, due_s) for key, due_s in _due(root, ticked) if key not in woken]
            due_s = min((due_s for _, due_s in reasons), default=until_s)
            # What a tick does not come to is not the reason for another one.
            woken.update(key for key, each_s in reasons if each_s <= max(due_s, world.now_s))
            instants = instants + 1 if due_s <= world.now_s else 0
            if instants >= instant_limit:
                return Course(None, world.now_s, tuple(world.begun), endless=True)
            world.now_s = max(world.now_s, due_s)
    finally:
        module.time = real_time
    return Course(None, until_s, tuple(world.begun))


def _due(
    root: Behaviour, ticked: Mapping[Behaviour, tuple[int, float]]
) -> Iterator[tuple[tuple[Behaviour, float], float]]:
    """Go through the reasons to tick: which one it is, and its time."""
    for node in root.iterate():
        if node.status is not Status.RUNNING:
            continue
        number, at_s = ticked.get(node, (0, 0.0))
        if isinstance(node, Scripted):
            yield (node, node.count), node.ends_s
        if isinstance(node, decorators.Repeat | decorators.Retry) and node.decorated.status is not Status.RUNNING:
            yield (node, number), at_s
        if isinstance(node, decorators.Timeout):
            yield (node, node.finish_time), round(node.finish_time, 3)
        if isinstance(node, HIDING) and node.decorated.status is not Status.RUNNING:
            yield (node, number), at_s + EVERY_S


def _built(specimen: Specimen, path: str, world: World) -> Behaviour:
    here = f"{path}/{specimen.name}"
    if specimen.leaf is not None:
        return Scripted(here.removeprefix("/"), specimen.leaf, world)
    children = [_built(child, here, world) for child in specimen.children]
    said = specimen.arguments
    match specimen.kind:
        case "sequence":
            return composites.Sequence(here, said["memory"], children)
        case "selector":
            return composites.Selector(here, said["memory"], children)
        case "parallel":
            return composites.Parallel(here, _policy(said["policy"], said["synchronise"], specimen, children), children)
        case "if_then_else" | "while_do_else":
            return Branching(here, children, reactive=specimen.kind == "while_do_else")
        case "inverter":
            return decorators.Inverter(here, children[0])
        case "one_shot":
            completion = said["policy"] == "completion"
            policy = OneShotPolicy.ON_COMPLETION if completion else OneShotPolicy.ON_SUCCESSFUL_COMPLETION
            return decorators.OneShot(here, children[0], policy)
        case "repeat":
            return decorators.Repeat(here, children[0], said["times"])
        case "retry":
            return decorators.Retry(here, children[0], said["times"] + 1)
        case "timeout":
            return decorators.Timeout(here, children[0], said["after"])
        case "condition":
            return decorators.Condition(here, children[0], STATUS[said["status"]])
        case "remap":
            ((actual, shown),) = ((key, value) for key, value in said.items() if key != "every")
            return REMAPS[actual, shown](here, children[0])
        case _:
            raise AssertionError(specimen.kind)


def _policy(
    policy: str | list[str], synchronise: bool, specimen: Specimen, children: list[Behaviour]
) -> ParallelPolicy.Base:
    if policy == "one":
        return ParallelPolicy.SuccessOnOne()
    if policy == "all":
        return ParallelPolicy.SuccessOnAll(synchronise=synchronise)
    chosen = [node for node, child in zip(children, specimen.children, strict=True) if child.name in policy]
    return ParallelPolicy.SuccessOnSelected(chosen, synchronise=synchronise)
