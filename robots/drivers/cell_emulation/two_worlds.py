"""Keeps the world of a cell and that of its Franka arms alike: who holds or moves a part says where it is in both.

The Franka arms are bodies in this world, where franky-sim has them. Who touches a part with a tool first has it until
it lets go. What falls, or is pushed, is moved by the world where that happens.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np

from engine.messages import Pose
from robots.drivers.franka.emulation.simulator_messages import RobotReport, SimulatorReport
from robots.sim.commands.world_commands import MirrorArm, MirrorPart
from robots.sim.world.sim_world import SimWorld

# Between two reports, 20 ms of franky-sim: a part that moves less is at rest.
_REST_M, _REST_RAD = 0.0001, 0.002
# Resting parts may differ that much between the worlds: each has its own contacts.
_ALIKE_M, _ALIKE_RAD = 0.001, 0.01


class PartKeeper(Protocol):
    """The world of the Franka arms, as this one changes it."""

    def keep(self, parts: Mapping[str, Pose | None]) -> None:
        """Keep parts where this world has them, and free those with None."""
        ...


class TwoWorlds:
    """Call `take` with each report of the Franka arms.

    Args:
        world: The open world of the others.
        arms: The Franka arms, in the order of the reports.
        franka: Where the Franka arms are.
    """

    def __init__(self, world: SimWorld, arms: Sequence[str], franka: PartKeeper) -> None:
        self._world = world
        self._arms = tuple(arms)
        self._franka = franka
        self._theirs: dict[str, Pose] = {}
        """The parts that Franka arms hold or move, with the last pose."""
        self._ours: dict[str, Pose] = {}
        """The parts that this world holds or moves, with the last pose."""
        self._last: dict[str, Pose] = {}
        self.report = SimulatorReport(time_s=0.0, late_s=0.0, robots=())
        """The last report."""

    @property
    def robots(self) -> Mapping[str, RobotReport]:
        """The Franka arms as last reported, none before the first report."""
        return dict(zip(self._arms, self.report.robots, strict=False))

    def take(self, report: SimulatorReport) -> None:
        """Take where Franka arms and parts are, and tell that world where the parts of this one are."""
        self.report = report
        for arm, robot in self.robots.items():
            position = np.array(robot.position_rad)
            command = MirrorArm(arm=arm, position_rad=position, velocity_rad_s=np.zeros(len(position)))
            self._world.host.send(command)
        there = {name: Pose(xyz=part.xyz, xyzw=part.xyzw) for name, part in report.parts.items()}
        fingers = {part for robot in report.robots for part in robot.touched}
        here, tools = self._here(), self._touched_here()
        for name, pose in there.items():
            self._decide(name, pose, here[name], theirs=name in fingers, ours=name in tools)

    def _decide(self, name: str, there: Pose, here: Pose, *, theirs: bool, ours: bool) -> None:
        """Say which world moves a part from now on: who has it keeps it while it touches or moves it."""
        if name in self._theirs:
            if not theirs and (ours or _alike(there, self._theirs[name], _REST_M, _REST_RAD)):
                del self._theirs[name]
                self._world.host.send(MirrorPart(part=name, pose=None))
            else:
                self._theirs[name] = there
                self._world.host.send(MirrorPart(part=name, pose=there))
                return
        elif theirs and not ours:
            if self._ours.pop(name, None) is not None:
                self._franka.keep({name: None})
            self._theirs[name] = there
            self._world.host.send(MirrorPart(part=name, pose=there))
            return
        self._keep_ours(name, there, here, touched=ours)

    def _keep_ours(self, name: str, there: Pose, here: Pose, *, touched: bool) -> None:
        """Keep a part of this world in the other one while it is touched or moves, and free it at rest."""
        moved = not _alike(here, self._last.get(name, here), _REST_M, _REST_RAD)
        self._last[name] = here
        if touched or moved or not _alike(here, there, _ALIKE_M, _ALIKE_RAD):
            self._ours[name] = here
            self._franka.keep({name: here})
        elif name in self._ours:
            del self._ours[name]
            self._franka.keep({name: None})

    def _here(self) -> dict[str, Pose]:
        summary = self._world.host.summary
        xyz, xyzw = self._world.measured().frames()
        row = {name: index for index, name in enumerate(summary.frames)}
        return {name: Pose(xyz=xyz[row[name]], xyzw=xyzw[row[name]]) for name in summary.parts}

    def _touched_here(self) -> frozenset[str]:
        """Return the bodies that the tools of the other arms touch."""
        snapshot, arms = self._world.measured(), self._world.host.summary.arms
        others = [arm.name for arm in arms if arm.tool is not None and arm.name not in self._arms]
        return frozenset(body for arm in others for body in snapshot.tool(arm).contacts)


def _alike(a: Pose, b: Pose, within_m: float, within_rad: float) -> bool:
    x, y, z, w = b.xyzw
    half_rad = min(math.dist(a.xyzw, b.xyzw), math.dist(a.xyzw, (-x, -y, -z, -w)))
    return math.dist(a.xyz, b.xyz) <= within_m and 2.0 * half_rad <= within_rad
