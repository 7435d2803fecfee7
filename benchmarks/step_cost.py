"""What a step of a simulated world costs, and how its cost is split, with both arms moving all the time."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.swinging_arms import Swinging
from engine.skills.arm_control import ControllerName, ControlSettings
from robots.control.commanding.arm_commands import ConfigureArm
from robots.scene.sim_scene import SimScene
from robots.sim.loop.arm_loop import SimArmLoop
from robots.sim.loop.simulation import Simulation
from robots.sim.physics.cell_model import build_cell
from robots.sim.physics.physics import Physics

_SETTLE_S = 0.5
# Neighbours on a shared machine make many steps dearer, none cheaper: costs are medians of blocks.
_BLOCK = 50


@dataclass(frozen=True, kw_only=True)
class StepCost:
    """Seconds of CPU of one step, medians; the factors say how much faster than real time it runs.

    `cpu_s` is of a step that nobody looks into; the four parts are of another run, in which the clocks
    around them take a few microseconds more, most of them from `rest_s`: grippers, feed-forward, the loop.
    """

    cpu_s: float
    cpu_factor: float
    wall_factor: float
    physics_s: float
    set_points_s: float
    laws_s: float
    rest_s: float
    contacts: int


def step_cost(scene: SimScene, controller: ControllerName, seconds: float) -> StepCost:
    """Build a world, let its parts settle, and step it for so long (simulated)."""
    simulation = Simulation(build_cell(scene))
    for arm in simulation.summary.arms:
        simulation.apply(ConfigureArm(arm=arm.name, settings=ControlSettings(controller=controller)))
    swinging = Swinging(simulation)
    for _ in range(round(_SETTLE_S / simulation.step_s)):
        swinging.step()
    count = round(seconds / simulation.step_s)
    wall_s, cpu_s, blocks = time.perf_counter(), time.process_time(), list[float]()
    for _ in range(count // _BLOCK):
        started_s = time.process_time()
        for _ in range(_BLOCK):
            swinging.step()
        blocks.append((time.process_time() - started_s) / _BLOCK)
    wall_s, cpu_s = time.perf_counter() - wall_s, time.process_time() - cpu_s
    passed_s = len(blocks) * _BLOCK * simulation.step_s
    physics_s, set_points_s, laws_s, rest_s = _parts(swinging, count // 2)
    return StepCost(
        cpu_s=float(np.median(blocks)),
        cpu_factor=passed_s / cpu_s,
        wall_factor=passed_s / wall_s,
        physics_s=physics_s,
        set_points_s=set_points_s,
        laws_s=laws_s,
        rest_s=rest_s,
        contacts=len(_settled(scene).contact_pairs()),
    )


def _parts(swinging: Swinging, count: int) -> tuple[float, ...]:
    """Return the median CPU seconds that a step spends in physics, set points, control laws, and the rest."""
    clocks = (_Clock(Physics, "start_step", "finish_step"), _Clock(SimArmLoop, "move"), _Clock(SimArmLoop, "drive"))
    blocks: list[tuple[float, ...]] = []
    with clocks[0].on(), clocks[1].on(), clocks[2].on():
        for _ in range(count // _BLOCK):
            started_s = time.thread_time()
            for _ in range(_BLOCK):
                swinging.step()
            whole_s = time.thread_time() - started_s
            parts_s = [clock.taken() for clock in clocks]
            blocks.append((*parts_s, whole_s - sum(parts_s)))
    return tuple(np.median(np.array(blocks) / _BLOCK, axis=0).tolist())


class _Clock:
    """Adds up the CPU seconds that methods of a class take."""

    def __init__(self, kind: type, *names: str) -> None:
        self._kind = kind
        self._methods: dict[str, Callable[..., Any]] = {name: getattr(kind, name) for name in names}
        self._spent_s = 0.0

    def taken(self) -> float:
        """Return the sum since the last call."""
        spent_s, self._spent_s = self._spent_s, 0.0
        return spent_s

    @contextmanager
    def on(self) -> Generator[None]:
        """Look at the methods while the block runs."""
        for name, method in self._methods.items():
            setattr(self._kind, name, self._timed(method))
        try:
            yield
        finally:
            for name, method in self._methods.items():
                setattr(self._kind, name, method)

    def _timed(self, method: Callable[..., Any]) -> Callable[..., Any]:
        def call(*args: Any, **options: Any) -> Any:
            started_s = time.thread_time()
            result = method(*args, **options)
            self._spent_s += time.thread_time() - started_s
            return result

        return call


def _settled(scene: SimScene) -> Physics:
    """Return the world without control at the moment when its parts have met what they lie on."""
    physics = Physics(build_cell(scene).model)
    for _ in range(20):
        physics.start_step()
        physics.finish_step()
    return physics
