"""The side channel of an emulated cell: says where everything in its world is, whatever the engine believes."""

from __future__ import annotations

from collections.abc import Mapping

from robots.drivers.cell_emulation.two_worlds import TwoWorlds
from robots.drivers.cell_emulation.world_time import WorldTime
from robots.drivers.emulation.side_channel import Request
from robots.sim.world.sim_world import SimWorld


class WorldJudge:
    """Executes the requests of the side channel: `do` names what, further keys its values.

    state: poses of all parts, joints of all arms, and what the tools touch, in the world; `late_s` is by how much
    its time is behind real time since it was opened. With Franka arms `franka_time_s` and `franka_late_s` are those of
    their world, which says what their fingers touch.
    """

    def __init__(self, world: SimWorld, time: WorldTime, franka: TwoWorlds | None = None) -> None:
        self._world = world
        self._time = time
        self._franka = franka

    async def execute(self, request: Request) -> Mapping[str, object]:
        """Execute one request; raises KeyError, TypeError or ValueError for what is not one."""
        if str(request["do"]) != "state":
            raise ValueError(f"{request['do']} is not known")
        return self._state()

    def _state(self) -> Mapping[str, object]:
        world, snapshot = self._world, self._world.measured()
        summary = world.host.summary
        xyz, xyzw = snapshot.frames()
        row = {name: index for index, name in enumerate(summary.frames)}
        tools = {arm.name: snapshot.tool(arm.name) for arm in summary.arms if arm.tool is not None}
        touched = {name: [body for body in tool.contacts if body] for name, tool in tools.items()}
        theirs: dict[str, object] = {}
        if self._franka is not None:
            report = self._franka.report
            touched |= {arm: list(robot.touched) for arm, robot in self._franka.robots.items()}
            theirs = {"franka_time_s": report.time_s, "franka_late_s": report.late_s}
        return {
            "time_s": snapshot.time_s,
            "late_s": self._time.late_s,
            "parts": {name: {"xyz": xyz[row[name]], "xyzw": xyzw[row[name]]} for name in summary.parts},
            "arms": {arm.name: snapshot.arm(arm.name).position_rad.tolist() for arm in summary.arms},
            "touched": touched,
            **theirs,
        }
