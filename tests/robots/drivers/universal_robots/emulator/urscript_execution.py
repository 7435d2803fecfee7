"""A program on an emulated controller without sockets and without time: cycles are counted."""

from __future__ import annotations

from robots.drivers.universal_robots.emulator.controller_state import ControllerState
from robots.drivers.universal_robots.emulator.emulated_arm import EmulatedArm
from robots.drivers.universal_robots.emulator.ur_models import ARMS
from robots.drivers.universal_robots.emulator.urscript.urscript_interpreter import UrscriptRun
from robots.drivers.universal_robots.emulator.urscript.urscript_parser import parse_program


def new_controller() -> ControllerState:
    """Return a UR10 of the CB3 series, ready to move."""
    return ControllerState(EmulatedArm(ARMS["ur10"], cycle_s=0.008))


def execute(source: str, *, cycles: int = 2_000, controller: ControllerState | None = None) -> ControllerState:
    """Execute a program to its end, or for so many cycles."""
    controller = controller or new_controller()
    controller.start_program(UrscriptRun(parse_program(source), controller))
    for _ in range(cycles):
        controller.run_cycle()
        if controller.program is None and controller.arm.is_at_rest:
            break
    return controller


def messages(source: str, *, cycles: int = 2_000) -> list[str]:
    """Return what a program reports with `textmsg`, and how it failed."""
    return list(execute(source, cycles=cycles).messages)
