"""The emulator as a whole: its ports, and the cycle that executes programs, moves the arm and sends data."""

from __future__ import annotations

import asyncio
from collections import OrderedDict
from collections.abc import AsyncGenerator
from contextlib import ExitStack, asynccontextmanager
from dataclasses import dataclass

from robots.drivers.emulation.input_wires import InputWires
from robots.drivers.emulation.plant import ALONE, Plant
from robots.drivers.universal_robots.emulator.controller_side_channel import ControllerSideChannel
from robots.drivers.universal_robots.emulator.controller_state import ControllerState
from robots.drivers.universal_robots.emulator.dashboard import BANNER, DashboardCommands
from robots.drivers.universal_robots.emulator.emulated_arm import EmulatedArm
from robots.drivers.universal_robots.emulator.link_faults import LinkFaults
from robots.drivers.universal_robots.emulator.rtde_server import RtdeServer
from robots.drivers.universal_robots.emulator.text_ports import dashboard_port, script_port
from robots.drivers.universal_robots.emulator.ur_models import ARMS, SERIES
from robots.drivers.universal_robots.emulator.urscript.urscript_interpreter import UrscriptRun
from robots.drivers.universal_robots.emulator.urscript.urscript_parser import parse_program
from robots.drivers.universal_robots.emulator.urscript.urscript_syntax import UrscriptError, UrscriptProgram

_MOST_LATE_CYCLES = 50
_CACHED_PROGRAMS = 8


@dataclass(frozen=True, slots=True)
class EmulatorPorts:
    """Where the emulator listens. Clients of Universal Robots have most of these built in."""

    dashboard: int = 29999
    scripts: tuple[int, ...] = (30001, 30002, 30003)
    rtde: int = 30004
    side_channel: int = 29900


class ControllerEmulator:
    """One controller on one address."""

    def __init__(self, *, model: str, series: str, plant: Plant = ALONE, tool_kg: float = 0.0) -> None:
        self._series = SERIES[series]
        arm = EmulatedArm(ARMS[model], cycle_s=1.0 / self._series.cycle_hz, plant=plant.arm)
        self.controller = ControllerState(arm, tool_kg=tool_kg, on_output=plant.on_output)
        self._wires = InputWires(plant.inputs, self.controller.set_digital_input)
        self._clock = plant.clock
        self._faults = LinkFaults()
        self._rtde = RtdeServer(self.controller, self._series, self._faults)
        self._side_channel = ControllerSideChannel(self.controller, self._faults)
        self._dashboard = DashboardCommands(self.controller, self._series, model=model)
        self._programs: OrderedDict[str, UrscriptProgram] = OrderedDict()

    @asynccontextmanager
    async def listening(self, host: str, ports: EmulatorPorts) -> AsyncGenerator[None]:
        """Listen on all ports."""
        loop = asyncio.get_running_loop()
        scripts = script_port(self._start_program, self._faults)
        dashboard = dashboard_port(self._dashboard.answer, self._faults, banner=BANNER)
        handlers = [(dashboard, ports.dashboard), *((scripts, port) for port in ports.scripts)]
        handlers.append((self._side_channel.serve, ports.side_channel))
        with ExitStack() as servers:
            servers.callback((await loop.create_server(self._rtde.new_session, host, ports.rtde)).close)
            for handler, port in handlers:
                servers.callback((await asyncio.start_server(handler, host, port)).close)
            yield

    async def run(self) -> None:
        """Execute cycles in the time of the plant, which is real time without a world, until cancelled."""
        clock = self._clock
        cycle_s = self.controller.arm.cycle_s
        due_s = clock.now_s()
        cycle = 0
        while True:
            await self._faults.alive()
            due_s += cycle_s
            # Also when it is late it serves the sockets in each cycle: a watchdog counts what comes in.
            await clock.sleep_until(due_s)
            if clock.now_s() - due_s > _MOST_LATE_CYCLES * cycle_s:
                due_s = clock.now_s()
            if self._faults.is_frozen:
                continue
            cycle += 1
            self._wires.follow()
            self.controller.run_cycle()
            self._rtde.send_data(cycle)
            self._side_channel.after_cycle()

    async def _start_program(self, source: str) -> None:
        """Start a program that a client has sent; what is no URScript is noted and changes nothing."""
        if not self.controller.is_remote:
            self.controller.messages.append("program refused: not in remote control")
            return
        try:
            program = self._programs.get(source)
            if program is None:
                # It takes 0.1 s and more: cycles go on meanwhile.
                program = await asyncio.to_thread(parse_program, source)
        except UrscriptError as error:
            self.controller.messages.append(f"compile error: {error}")
            return
        self._programs[source] = program
        self._programs.move_to_end(source)
        while len(self._programs) > _CACHED_PROGRAMS:
            self._programs.popitem(last=False)
        execution = UrscriptRun(program, self.controller)
        if program.is_secondary:
            self.controller.start_secondary(execution)
        else:
            self.controller.start_program(execution)
