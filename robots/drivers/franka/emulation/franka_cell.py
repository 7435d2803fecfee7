"""The control cabinets of all Franka arms of a cell, on one simulator with its fixtures and parts."""

from __future__ import annotations

from collections.abc import Mapping

from robots.drivers.emulation.side_channel import Request, SideChannel
from robots.drivers.franka.emulation.control_cabinet import ARM_PORT, HAND_PORT, ControlCabinet, inner_address
from robots.drivers.franka.emulation.franka_emulator import FrankaEmulatorOptions
from robots.drivers.franka.emulation.simulated_robot import RobotSimulator
from robots.drivers.franka.emulation.simulator_messages import RobotSetup, SimulatorSetup
from robots.scene.sim_scene import SimScene


class FrankaCell:
    """Robots by the names of their arms; franky-sim moves their joints by torques, so that it brings its own world.

    Args:
        hosts: Address of the cabinet of each arm.
        scene: The cell; its other arms are not there.
        report_steps: The simulator reports after so many milliseconds of its time.
    """

    def __init__(self, hosts: Mapping[str, str], scene: SimScene, *, report_steps: int = 50) -> None:
        placements = {arm.name: arm for arm in scene.arms}
        robots = tuple(
            RobotSetup(host=inner_address(host), base=placements[arm].base, start_rad=placements[arm].robot().home_rad)
            for arm, host in hosts.items()
        )
        self._hosts = dict(hosts)
        self.simulator = RobotSimulator(SimulatorSetup(robots=robots, scene=scene, report_steps=report_steps))
        self._cabinets = {
            arm: ControlCabinet(FrankaEmulatorOptions(host=host), robot)
            for (arm, host), robot in zip(hosts.items(), self.simulator.robots, strict=True)
        }
        self._sides = {
            arm: SideChannel(cabinet.execute, host=hosts[arm], port=0) for arm, cabinet in self._cabinets.items()
        }

    async def open(self) -> dict[str, dict[str, str | int]]:
        """Listen, and return where, by the name of the arm; raises CellError."""
        places: dict[str, dict[str, str | int]] = {}
        for arm, cabinet in self._cabinets.items():
            await cabinet.open()
            side_port = await self._sides[arm].open()
            places[arm] = {
                "connection": "fci", "host": self._hosts[arm], "arm": ARM_PORT, "hand": HAND_PORT,
                "side_port": side_port,
            }  # fmt: skip
        return places

    async def close(self) -> None:
        """End all of it."""
        for arm, cabinet in self._cabinets.items():
            self._sides[arm].close()
            await cabinet.close()
        await self.simulator.stop()

    async def execute(self, request: Request) -> Mapping[str, object]:
        """Execute a request of the side channel of the cell: `state`, with where everything is.

        Raises:
            ValueError: it is another one.
        """
        if str(request["do"]) != "state":
            raise ValueError(f"{request['do']} is not known")
        report = self.simulator.report
        assert report is not None
        robots = dict(zip(self._cabinets, report.robots, strict=True))
        return {
            "time_s": report.time_s,
            "late_s": report.late_s,
            "parts": {name: {"xyz": part.xyz, "xyzw": part.xyzw} for name, part in report.parts.items()},
            "arms": {arm: robot.position_rad for arm, robot in robots.items()},
            "touched": {arm: robot.touched for arm, robot in robots.items()},
        }
