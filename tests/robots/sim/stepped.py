"""One arm of a simulation, stepped by hand: commands between steps, and what it measures after each."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from engine.messages import Vector3
from engine.skills.arm_control import ControlSettings
from engine.skills.simulated_world import PushBody
from robots.control.commanding.arm_commands import ConfigureArm, FollowTrajectory
from robots.control.motion_event import AnyMotionEvent, MotionFinished
from robots.port import ArmSample, Array, MotionReport, Tolerance
from robots.sim.commands.world_commands import AnyCommand, PushSimBody
from robots.sim.loop.simulation import Simulation
from robots.sim.loop.snapshot import SimSnapshot
from robots.sim.physics.cell_model import CellModel
from tests.robots.sim.sim_cell import smooth

TOOL = "left/panda_hand_tcp"


class SteppedArm:
    """The left arm of a world of its own; a built cell may be shared, it is only read."""

    def __init__(self, cell: CellModel, settings: ControlSettings | None = None) -> None:
        self.simulation = Simulation(cell)
        self.control = self.simulation.control("left")
        self.events: list[AnyMotionEvent] = []
        if settings is not None:
            self.configure(settings)

    def configure(self, settings: ControlSettings) -> None:
        """Put these settings into force."""
        self.apply(ConfigureArm(arm="left", settings=settings))

    def apply(self, command: AnyCommand) -> None:
        """Give a command."""
        self.simulation.apply(command)

    def push(self, force_n: Vector3, duration_s: float, *, body: str = TOOL, at_m: Vector3 = (0.0, 0.0, 0.0)) -> None:
        """Push at a body."""
        self.apply(PushSimBody(push=PushBody(body=body, force_n=force_n, duration_s=duration_s, at_m=at_m)))

    def follow(self, goal: Array, duration_s: float, *, motion: int = 1) -> None:
        """Start a minimum-jerk motion from the set point."""
        way = smooth(self.sample.desired_rad.copy(), goal, duration_s)
        self.apply(FollowTrajectory(arm="left", motion=motion, trajectory=way, tolerance=Tolerance()))

    @property
    def sample(self) -> ArmSample:
        """What is measured now."""
        values = self.simulation.layout.new_array()
        self.simulation.write_snapshot(values)
        return SimSnapshot(self.simulation.layout, values).arm("left")

    @property
    def tool_xyz(self) -> Array:
        """Where the tool centre point is measured."""
        return self.control.state.kinematics.tool_pose(self.sample.position_rad).xyz

    def step(self) -> None:
        """Let one step pass."""
        self.events.extend(self.simulation.step())

    def run(self, seconds: float, *, look: Callable[[], None] | None = None) -> None:
        """Let time pass, and look after every step."""
        for _ in range(round(seconds / self.simulation.step_s)):
            self.step()
            if look is not None:
                look()

    def until_finished(self, motion: int = 1, *, within_s: float = 10.0) -> MotionReport:
        """Let time pass until a motion has ended, and return its end."""
        for _ in range(round(within_s / self.simulation.step_s)):
            for event in self.events:
                if isinstance(event, MotionFinished) and event.motion == motion:
                    return event.report
            self.step()
        raise AssertionError(f"motion {motion} did not end within {within_s} s")


class BumpWatch:
    """What a change of law does to an arm: greatest step of a torque, speed and way of the tool."""

    def __init__(self, arm: SteppedArm, seconds: float) -> None:
        torques, places = [arm.sample.effort_nm.copy()], [arm.tool_xyz]

        def look() -> None:
            torques.append(arm.sample.effort_nm.copy())
            places.append(arm.tool_xyz)

        arm.run(seconds, look=look)
        way = np.array(places)
        self.torque_step_nm = float(np.abs(np.diff(np.array(torques), axis=0)).max())
        self.speed_m_s = float(np.linalg.norm(np.diff(way, axis=0), axis=1).max() / arm.simulation.step_s)
        self.moved_m = float(np.linalg.norm(way - way[0], axis=1).max())
