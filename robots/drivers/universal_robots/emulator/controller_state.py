"""Everything that an emulated controller knows, and what it does in each of its cycles."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from enum import IntEnum
from typing import Protocol

from robots.drivers.emulation.plant import OutputListener, unconnected
from robots.drivers.universal_robots.emulator.controller_safety import ControllerSafety
from robots.drivers.universal_robots.emulator.emulated_arm import (
    PROGRAM_STOP_RAD_S2,
    SAFETY_STOP_RAD_S2,
    ArmLimitError,
    EmulatedArm,
)

REGISTERS = 48
_INT32 = 1 << 31
# Standard outputs or inputs, then those of the tool: numbered as drivers do.
_WIRED_BITS = (*range(8), 16, 17)
_MOST_SECONDARY = 10


class UrRuntimeState(IntEnum):
    """RTDE variable `runtime_state`."""

    STOPPING = 0
    STOPPED = 1
    PLAYING = 2
    PAUSING = 3
    PAUSED = 4
    RESUMING = 5


class UrProgram(Protocol):
    """A program that is executed one cycle at a time."""

    @property
    def name(self) -> str:
        """The name behind `def`."""
        ...

    def step(self) -> bool:
        """Execute one cycle; returns whether the program goes on."""
        ...


@dataclass(slots=True)
class RtdeWatchdog:
    """Stops or pauses the program when an input has not been written for a time."""

    variable: str
    period_s: float
    action: str


class ControllerState:
    """One controller with one arm. Only the task of the cycle and the sessions of clients, on one loop, change it.

    `tool_kg` is the part of the payload that belongs to the plant.
    """

    def __init__(self, arm: EmulatedArm, *, tool_kg: float = 0.0, on_output: OutputListener = unconnected) -> None:
        self.arm = arm
        self._tool_kg = tool_kg
        self._on_output = on_output
        self.safety = ControllerSafety()
        self.time_s = 0.0
        self.program: UrProgram | None = None
        self._secondary: list[UrProgram] = []
        self.is_paused = False
        self.is_remote = True
        self.program_name = ""
        self.input_ints = [0] * REGISTERS
        self.input_doubles = [0.0] * REGISTERS
        self.output_ints = [0] * REGISTERS
        self.output_doubles = [0.0] * REGISTERS
        self.digital_inputs = 0
        self.digital_outputs = 0
        self.analog_outputs = [0.0, 0.0]
        self.speed_fraction = 1.0
        self.payload_kg = 0.0
        self.payload_cog_m = (0.0, 0.0, 0.0)
        self.payload_inertia_kgm2 = (0.0,) * 6
        self.tcp_force_n = (0.0,) * 6
        self.contact_steps = 0
        self.start_delay_s = 0.0
        """How long a program is loaded, and counts as running, before its first statement is executed."""
        self._executes_from_s = 0.0
        self.messages: deque[str] = deque(maxlen=50)
        self._watchdog: RtdeWatchdog | None = None
        self._written_s: dict[str, float] = {}

    @property
    def speed_scaling(self) -> float:
        """The fraction of the programmed speed that motions have."""
        return self.speed_fraction

    @property
    def runtime_state(self) -> UrRuntimeState:
        """Whether a program runs."""
        if self.program is None:
            return UrRuntimeState.STOPPED
        return UrRuntimeState.PAUSED if self.is_paused else UrRuntimeState.PLAYING

    @property
    def robot_status_bits(self) -> int:
        """RTDE variable `robot_status_bits`: power, program running."""
        return int(self.safety.is_powered) | (self.program is not None) << 1

    @property
    def written_s(self) -> float:
        """When a client has written an input last, by its own time; minus infinity before the first time."""
        return max(self._written_s.values(), default=-math.inf)

    def note_input(self, name: str) -> None:
        """Note that a client has written an input: it is what a watchdog waits for."""
        self._written_s[name] = self.time_s

    def set_digital_outputs(self, mask: int, bits: int) -> None:
        """Change the outputs of the mask: bits 0 to 7 standard, 8 to 15 configurable, 16 and 17 tool."""
        mask &= 0x3FFFF
        before, self.digital_outputs = self.digital_outputs, self.digital_outputs & ~mask | bits & mask
        changed = before ^ self.digital_outputs
        for output, bit in enumerate(_WIRED_BITS):
            if changed >> bit & 1:
                self._on_output(output, on=bool(self.digital_outputs >> bit & 1))

    def set_digital_input(self, number: int, *, on: bool) -> None:
        """Turn an input on or off: 0 to 7 standard, then those of the tool; nothing for others."""
        if number < len(_WIRED_BITS):
            bit = 1 << _WIRED_BITS[number]
            self.digital_inputs = self.digital_inputs & ~bit | (bit if on else 0)

    def set_speed_fraction(self, fraction: float) -> None:
        """Move the speed slider."""
        self.speed_fraction = min(1.0, max(0.0, fraction))

    def set_output_int(self, index: int, value: int) -> None:
        """Write an integer register; it wraps as 32 bits do."""
        self.output_ints[index] = (value + _INT32) % (2 * _INT32) - _INT32

    def set_watchdog(self, variable: str, min_frequency_hz: float, action: str) -> None:
        """Watch an input from now on; a frequency of zero ends it."""
        if min_frequency_hz <= 0.0:
            self._watchdog = None
            return
        self._watchdog = RtdeWatchdog(variable, 1.0 / min_frequency_hz, action)
        self._written_s[variable] = self.time_s

    def start_program(self, program: UrProgram) -> bool:
        """Replace the program; refused while a stop or missing power forbids motion."""
        if not self.safety.can_move:
            self.messages.append(f"program {program.name} refused: the robot cannot move")
            return False
        self.stop_program()
        self.arm.settle()
        self.program, self.program_name = program, program.name
        self._executes_from_s = self.time_s + self.start_delay_s
        return True

    def start_secondary(self, program: UrProgram) -> None:
        """Execute a program beside the main one; it ends within the cycles that it takes."""
        self._secondary = [*self._secondary[-_MOST_SECONDARY:], program]

    def stop_program(self) -> None:
        """End the program; the arm comes to rest by itself."""
        self.program, self.is_paused, self._watchdog = None, False, None

    def protective_stop(self, reason: str) -> None:
        """Stop the arm and the program; a person has to unlock it."""
        self.messages.append(f"protective stop: {reason}")
        self.safety.protective_stop(self.time_s)
        self.stop_program()

    def emergency_stop(self) -> None:
        """Stop the arm and the program, and take its power."""
        self.messages.append("emergency stop")
        self.safety.emergency_stop()
        self.stop_program()

    def power_off(self) -> None:
        """Take the power of the arm."""
        self.safety.power_off()
        self.stop_program()

    def run_cycle(self) -> None:
        """Execute the program and move the arm for one cycle."""
        self.time_s += self.arm.cycle_s
        self._check_watchdog()
        program = self.program
        if program is not None and self._executes and not self._step(program) and self.program is program:
            self.stop_program()
        self._secondary = [secondary for secondary in self._secondary if self._step(secondary)]
        self.arm.plant.carry(max(0.0, self.payload_kg - self._tool_kg))
        self.arm.finish_cycle(PROGRAM_STOP_RAD_S2 if self.safety.can_move else SAFETY_STOP_RAD_S2)
        if self.arm.plant.problem and self.safety.can_move:
            self.protective_stop(self.arm.plant.problem)

    @property
    def _executes(self) -> bool:
        return not self.is_paused and self.time_s >= self._executes_from_s

    def _step(self, program: UrProgram) -> bool:
        """Execute a cycle of a program; returns whether it goes on."""
        try:
            return program.step()
        except ArmLimitError as error:
            self.protective_stop(str(error))
            return False

    def _check_watchdog(self) -> None:
        watchdog = self._watchdog
        if watchdog is None or self.time_s - self._written_s[watchdog.variable] <= watchdog.period_s:
            return
        self.messages.append(f"watchdog of {watchdog.variable}: {watchdog.action}")
        if watchdog.action == "stop":
            self.stop_program()
        elif watchdog.action == "pause":
            self.is_paused = True
