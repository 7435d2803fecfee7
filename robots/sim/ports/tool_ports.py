"""The ports of simulated tools: gripper, hand, magnet, the same for both hosts."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TypeVar

from engine.errors import CellError, RobotError
from robots.port import GripperSample, HandSample, MagnetSample
from robots.sim.commands.world_commands import CloseFingers, CloseHand, SwitchMagnet, ToolCommand
from robots.sim.grip.tool_summary import ToolSummary
from robots.sim.host.world_host import WorldHost
from robots.sim.loop.snapshot import ArmSummary
from robots.sim.ports.exclusive_motion import ExclusiveMotion
from robots.sim.ports.motion_registry import MotionRegistry, SimMotion

Port = TypeVar("Port")


class _ToolPort:
    """Base of all tool ports: command channel and exclusive motion."""

    def __init__(self, host: WorldHost, board: MotionRegistry, arm: str, tool: ToolSummary) -> None:
        self.host = host
        self.arm = arm
        self.tool = tool
        self.address = f"{arm}/{tool.device}"
        self._one = ExclusiveMotion(self.address, board)

    def number(self) -> int:
        """Return the number for the next motion."""
        return self._one.number()

    def start(self, command: ToolCommand) -> SimMotion:
        """Send a command that starts a motion."""
        host, arm, number = self.host, self.arm, command.motion
        motion = SimMotion(number, send=host.send, progress=lambda: host.snapshot().tool_progress(arm, number))
        return self._one.start(motion, host, command)

    def require(self, what: str, value: float, *, above_zero: bool) -> None:
        """Raise RobotError unless `value` is finite and at least 0, or above 0 with `above_zero`."""
        if not math.isfinite(value) or value < 0.0 or (above_zero and value == 0.0):
            raise RobotError(f"{what} cannot be {value}", where=self.address)


class SimGripperPort:
    """Implements `robots.port.GripperPort` for a gripper of a simulated world."""

    def __init__(self, host: WorldHost, board: MotionRegistry, arm: str, tool: ToolSummary) -> None:
        self._line = _ToolPort(host, board, arm, tool)

    @property
    def max_width_m(self) -> float:
        """Opening when fully open."""
        return self._line.tool.max_width_m

    @property
    def max_force_n(self) -> float:
        """Maximum grip force."""
        return self._line.tool.max_force_n

    def sample(self) -> GripperSample:
        """Return the latest measurement."""
        return self._line.host.snapshot().gripper(self._line.arm)

    def close_to(self, *, width_m: float, speed_m_s: float, force_n: float) -> SimMotion:
        """Move the fingers towards `width_m`, pressing with at most `force_n`.

        Raises:
            RobotError: another motion is active, a value is invalid, or the world is lost.
        """
        line = self._line
        number = line.number()
        line.require("width_m", width_m, above_zero=False)
        line.require("speed_m_s", speed_m_s, above_zero=True)
        line.require("force_n", force_n, above_zero=True)
        command = CloseFingers(arm=line.arm, motion=number, width_m=width_m, speed_m_s=speed_m_s, force_n=force_n)
        return line.start(command)


class SimHandPort:
    """Implements `robots.port.HandPort` for a hand of a simulated world."""

    def __init__(self, host: WorldHost, board: MotionRegistry, arm: str, tool: ToolSummary) -> None:
        self._line = _ToolPort(host, board, arm, tool)

    @property
    def max_force_n(self) -> float:
        """Maximum pull of the motor."""
        return self._line.tool.max_force_n

    def sample(self) -> HandSample:
        """Return the latest measurement."""
        return self._line.host.snapshot().hand(self._line.arm)

    def close_to(self, *, share: float, time_s: float) -> SimMotion:
        """Close or open to `share`, 0 to 1, in `time_s` or as fast as the motor can.

        Raises:
            RobotError: another motion is active, a value is invalid, or the world is lost.
        """
        line = self._line
        number = line.number()
        line.require("share", share, above_zero=False)
        line.require("time_s", time_s, above_zero=True)
        return line.start(CloseHand(arm=line.arm, motion=number, share=share, time_s=time_s))


class SimMagnetPort:
    """Implements `robots.port.MagnetPort` for a magnet of a simulated world."""

    def __init__(self, host: WorldHost, board: MotionRegistry, arm: str, tool: ToolSummary) -> None:
        self._line = _ToolPort(host, board, arm, tool)

    @property
    def max_force_n(self) -> float:
        """Pull on a plate that covers its face."""
        return self._line.tool.max_force_n

    def sample(self) -> MagnetSample:
        """Return the latest measurement."""
        return self._line.host.snapshot().magnet(self._line.arm)

    def switch(self, *, on: bool) -> SimMotion:
        """Switch the field.

        Raises:
            RobotError: another switch is active, or the world is lost.
        """
        line = self._line
        return line.start(SwitchMagnet(arm=line.arm, motion=line.number(), on=on))


class ToolPorts:
    """The ports of the tools of all arms, by the arm's name."""

    def __init__(self, host: WorldHost, board: MotionRegistry, arms: Mapping[str, ArmSummary]) -> None:
        self._grippers: dict[str, SimGripperPort] = {}
        self._hands: dict[str, SimHandPort] = {}
        self._magnets: dict[str, SimMagnetPort] = {}
        for name, arm in arms.items():
            tool = arm.tool
            if tool is None:
                continue
            match tool.device:
                case "gripper":
                    self._grippers[name] = SimGripperPort(host, board, name, tool)
                case "hand":
                    self._hands[name] = SimHandPort(host, board, name, tool)
                case "magnet":
                    self._magnets[name] = SimMagnetPort(host, board, name, tool)

    def gripper(self, arm: str) -> SimGripperPort:
        """Return the port of the gripper on an arm; raises CellError where there is none."""
        return _of(self._grippers, arm, "gripper")

    def hand(self, arm: str) -> SimHandPort:
        """Return the port of the hand on an arm; raises CellError where there is none."""
        return _of(self._hands, arm, "hand")

    def magnet(self, arm: str) -> SimMagnetPort:
        """Return the port of the magnet on an arm; raises CellError where there is none."""
        return _of(self._magnets, arm, "magnet")


def _of(ports: Mapping[str, Port], arm: str, device: str) -> Port:
    if arm not in ports:
        raise CellError(f"the arm carries no {device}", where=arm, hint=f"arms with one: {', '.join(ports) or 'none'}")
    return ports[arm]
