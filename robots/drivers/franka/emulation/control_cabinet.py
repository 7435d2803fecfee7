"""An emulated control cabinet: the links of arm and hand, the simulated robot behind them, and its side channel."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import msgspec

from robots.drivers.emulation.serve_emulator import number
from robots.drivers.emulation.side_channel import Request
from robots.drivers.franka.emulation.arm_rules import ROBOT_HEADER, ArmRules
from robots.drivers.franka.emulation.command_link import CommandLink
from robots.drivers.franka.emulation.franka_emulator import FrankaEmulatorOptions
from robots.drivers.franka.emulation.hand_rules import HAND_HEADER, HandRules
from robots.drivers.franka.emulation.link_state import LinkState
from robots.drivers.franka.emulation.simulated_robot import PORTS, SimulatedRobot, single_robot
from robots.drivers.franka.franka_faults import FrankaMode

ARM_PORT, HAND_PORT = PORTS
_MODES = {
    "user_stop": FrankaMode.USER_STOPPED,
    "guiding": FrankaMode.GUIDING,
    "lock": FrankaMode.OTHER,
}


def inner_address(host: str) -> str:
    """Return the address of the simulated robot behind a cabinet: the same in another part of the loopback network."""
    first, second, third, fourth = host.split(".")
    return f"{first}.{int(second) ^ 0x80}.{third}.{fourth}"


class ControlCabinet:
    """Executes the requests of the side channel; without a `robot` it has one of its own."""

    def __init__(self, options: FrankaEmulatorOptions, robot: SimulatedRobot | None = None) -> None:
        host, inner = options.host, inner_address(options.host)
        self._lost_packets = options.lost_packets
        self.faults = LinkState()
        self.arm = ArmRules(lost_packets=options.lost_packets)
        self.hand = HandRules(homed=options.homed)
        self.robot = robot or single_robot(inner)
        self.arm_link = CommandLink(
            host=host, inner_host=inner, port=ARM_PORT, header=ROBOT_HEADER, rules=self.arm, faults=self.faults
        )
        self.hand_link = CommandLink(
            host=host, inner_host=inner, port=HAND_PORT, header=HAND_HEADER, rules=self.hand, faults=self.faults
        )

    async def open(self) -> None:
        """Start the simulated robot and listen; raises CellError."""
        await self.robot.simulator.start()
        await self.arm_link.open()
        await self.hand_link.open()

    async def close(self) -> None:
        """End all of it."""
        self.arm_link.close()
        self.hand_link.close()
        await self.robot.simulator.stop()

    async def execute(self, request: Request) -> Mapping[str, object]:
        """Execute a request; raises ValueError for one that is not known."""
        match str(request["do"]):
            case "state":
                return self.state()
            case "wait":
                await self.arm.until(self._condition(str(request["until"])))
                return self.state()
            case "restart":
                await self._restart()
            case other:
                self._switch(other, request)
        return {"ok": True}

    def state(self) -> Mapping[str, object]:
        """Return the true state."""
        arm, latest = self.arm, self.arm.latest
        return {
            "mode": arm.mode.name,
            "is_controlled": arm.is_controlled,
            "time_s": latest.time_s if latest is not None else 0.0,
            "q": latest.q if latest is not None else (),
            "dq": latest.dq if latest is not None else (),
            "tcp_m": latest.tcp_m if latest is not None else (),
            "load_kg": latest.load_kg if latest is not None else 0.0,
            "settings": arm.settings,
            "recoveries": arm.recoveries,
            "reflex_torque_nm": arm.reflex_torque_nm,
            "width_m": self.robot.width_m,
            "speed_m_s": self.robot.speed_m_s,
            "travel": self.robot.travel_m,
            "joints_rad": self.robot.joints_rad,
            "fastest_rad_s": self.robot.fastest_rad_s,
            "homed": self.hand.homed,
            "homings": self.hand.homings,
            "commands": self.hand.requests,
        }

    def _switch(self, what: str, request: Request) -> None:
        match what:
            case "reflex":
                self.arm.stop_by(FrankaMode.REFLEX, msgspec.convert(request.get("errors", ["joint_reflex"]), list[str]))
            case "user_stop" | "guiding" | "lock":
                if request.get("on", True):
                    self.arm.stop_by(_MODES[what])
                else:
                    self.arm.release()
            case "force":
                # The robot reports what the tool exerts, not what acts on it.
                force = msgspec.convert(request["force_n"], list[float] | None)
                self.arm.wrench = None if force is None else [-each for each in force]
            case "lost_packets":
                self.arm.lost_packets = int(number(request["count"]))
            case "object":
                width = request["width_m"]
                self.robot.simulator.place_object(0.0 if width is None else number(width))
            case "homed":
                self.hand.homed = bool(request["on"])
            case "version":
                self.arm_link.foreign_version = int(number(request["version"]))
            case "cut" | "drop":
                self.faults.is_cut = what == "cut"
                self.arm_link.drop()
                self.hand_link.drop()
            case "freeze":
                self.faults.freeze()
            case "slow":
                self.faults.delay_s = max(0.0, number(request["seconds"]))
            case "restore":
                self.faults.restore()
                self.arm.release()
                self.arm.wrench, self.arm.lost_packets, self.arm_link.foreign_version = None, self._lost_packets, 0
            case _:
                raise ValueError(f"{what} is not known")

    async def _restart(self) -> None:
        if len(self.robot.simulator.robots) > 1:
            raise ValueError("the robots of a cell have one simulator: restart the emulated cell")
        self.faults.is_cut = True
        self.arm_link.drop()
        self.hand_link.drop()
        await self.robot.simulator.stop()
        await self.robot.simulator.start()
        self.arm.release()
        self.hand.homed = False
        self.faults.is_cut = False

    def _condition(self, until: str) -> Callable[[], bool]:
        arm = self.arm
        conditions: Mapping[str, Callable[[], bool]] = {
            "moving": lambda: not arm.is_at_rest,
            "at_rest": lambda: arm.is_at_rest,
            "controlled": lambda: arm.is_controlled,
            "free": lambda: not arm.is_controlled,
        }
        if until not in conditions:
            raise ValueError(f"`until` is one of {', '.join(conditions)}")
        return conditions[until]
