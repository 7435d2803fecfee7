"""The control program, executed by the emulator without sockets and without time: set points, silence, limits."""

from __future__ import annotations

import re

import pytest

from robots.drivers.universal_robots.control_program import (
    INPUT_DOUBLES,
    INPUT_INTS,
    INPUT_TYPES,
    INPUTS,
    OUTPUT_INTS,
    PROGRAM,
    ControlRequest,
    ControlState,
    control_program,
)
from robots.drivers.universal_robots.emulator.controller_state import ControllerState
from robots.drivers.universal_robots.emulator.urscript.urscript_interpreter import UrscriptRun
from robots.drivers.universal_robots.emulator.urscript.urscript_parser import parse_program
from tests.robots.drivers.universal_robots.emulator.urscript_execution import new_controller

SESSION = 77
STEP_S = 0.008


class Session:
    """One run of the program, and the registers that the driver writes."""

    def __init__(self) -> None:
        self.controller: ControllerState = new_controller()
        self.start = self.controller.arm.q.tolist()
        source = control_program(
            session=SESSION,
            step_s=STEP_S,
            silence_limit_s=0.1,
            distance_limit_rad=0.5,
            lookahead_s=0.05,
            servo_gain=300.0,
        )
        self.number = 0
        self.write(ControlRequest.REST, self.start)
        self.controller.start_program(UrscriptRun(parse_program(source), self.controller))

    def write(
        self,
        request: ControlRequest,
        q: list[float],
        *,
        session: int = SESSION,
        settings: tuple[int, list[float]] = (0, [0.0] * 10),
        output: tuple[int, int, int] = (0, 0, 0),
    ) -> None:
        """Write all inputs as one set point."""
        self.number += 1
        self.controller.input_ints[:INPUT_INTS] = [session, self.number, request, settings[0], *output]
        for name in INPUTS:
            self.controller.note_input(name)
        self.controller.input_doubles[:INPUT_DOUBLES] = [*q, *settings[1]]

    def cycles(self, count: int) -> None:
        """Execute so many cycles."""
        for _ in range(count):
            self.controller.run_cycle()

    def follow(self, step_rad: float, count: int, **inputs: object) -> None:
        """Move the first joint by this much in each of so many cycles."""
        q = self.controller.arm.q.tolist()
        for _ in range(count):
            q[0] += step_rad
            self.write(ControlRequest.FOLLOW, q, **inputs)  # type: ignore[arg-type]
            self.cycles(1)

    @property
    def state(self) -> ControlState:
        """What the program says of itself."""
        return ControlState(self.controller.output_ints[1])

    @property
    def is_playing(self) -> bool:
        """Whether the controller executes it."""
        return self.controller.program is not None


def test_set_points_are_followed_and_each_is_acknowledged() -> None:
    run = Session()
    run.follow(0.002, 200)
    assert (run.state, run.is_playing) == (ControlState.RUNNING, True)
    assert run.controller.output_ints[0] == SESSION
    assert run.controller.output_ints[3] == run.number
    # Behind by the lookahead at 0.25 rad/s.
    assert run.controller.arm.q[0] == pytest.approx(0.4 - 0.25 * 0.05, abs=0.005)


def test_without_a_new_set_point_the_arm_is_stopped_and_the_program_ends() -> None:
    run = Session()
    run.follow(0.005, 100)
    run.cycles(11)
    assert run.is_playing
    run.cycles(3)
    assert run.state is ControlState.NO_SET_POINT
    run.cycles(40)
    assert (run.is_playing, run.controller.arm.is_at_rest) == (False, True)
    assert run.controller.messages == type(run.controller.messages)()


def test_a_paused_program_whose_driver_is_gone_moves_nothing_when_a_person_resumes_it() -> None:
    """Its link was cut before the driver could ask it to end: the registers still have the last set point."""
    run = Session()
    run.follow(0.005, 100)
    run.write(ControlRequest.FOLLOW, [float(run.controller.arm.q[0]) + 0.3, *run.start[1:]])
    run.controller.is_paused = True
    run.cycles(200)
    rest = run.controller.arm.q.tolist()
    assert not run.is_playing
    run.controller.is_paused = False
    run.cycles(40)
    assert run.controller.arm.q.tolist() == pytest.approx(rest, abs=1e-4)


@pytest.mark.parametrize("ahead_rad", [0.0, 0.3], ids=["all set points executed", "one came while it was paused"])
@pytest.mark.parametrize("paused_cycles", [1, 20, 100])
def test_a_paused_program_that_a_person_resumes_at_once_goes_nowhere_without_its_driver(
    ahead_rad: float, paused_cycles: int
) -> None:
    """Within the second until the controller ends it; the registers still have the last set point."""
    run = Session()
    run.follow(0.008, 100)
    run.controller.is_paused = True
    if ahead_rad:
        q = [float(run.controller.arm.q[0]) + ahead_rad, *run.start[1:]]
        run.write(ControlRequest.FOLLOW, q, output=(1, 3, 1))
    while not run.controller.arm.is_at_rest:
        run.cycles(1)
    run.cycles(paused_cycles)
    rest = run.controller.arm.q.tolist()
    assert run.is_playing
    run.controller.is_paused = False
    for _ in range(40):
        run.cycles(1)
        assert run.controller.arm.q.tolist() == pytest.approx(rest, abs=0.005)
    assert (run.state, run.is_playing) == (ControlState.NO_SET_POINT, False)
    assert run.controller.digital_outputs == 0


def test_an_arm_at_rest_follows_set_points_that_begin_far_off_it_once_two_have_come() -> None:
    """Where a motion begins fast, or an arm turns round."""
    run = Session()
    run.follow(0.02, 1)
    run.cycles(3)
    assert run.controller.arm.q.tolist() == run.start
    run.follow(0.02, 2)
    assert run.controller.arm.q[0] > run.start[0]


def test_set_points_of_another_session_count_as_silence() -> None:
    run = Session()
    run.follow(0.005, 20)
    moved = run.controller.arm.q[0]
    run.follow(0.005, 60, session=SESSION + 1)
    assert (run.state, run.is_playing) == (ControlState.NO_SET_POINT, False)
    assert run.controller.arm.q[0] < moved + 0.15


def test_a_set_point_that_is_far_off_the_arm_ends_the_program() -> None:
    run = Session()
    run.write(ControlRequest.FOLLOW, [0.6, *run.start[1:]])
    run.cycles(3)
    assert (run.state, run.is_playing) == (ControlState.TOO_FAR, False)
    assert run.controller.arm.q.tolist() == run.start


def test_a_set_point_that_is_no_number_moves_nothing() -> None:
    """The driver sends none; the emulator ends a program that computes with it."""
    run = Session()
    run.write(ControlRequest.FOLLOW, [float("nan"), *run.start[1:]])
    run.cycles(3)
    assert not run.is_playing
    assert run.controller.arm.q.tolist() == run.start


def test_it_ends_at_rest_when_it_is_asked_to() -> None:
    run = Session()
    run.follow(0.005, 50)
    run.write(ControlRequest.END, run.controller.arm.q.tolist())
    run.cycles(1)
    assert run.is_playing
    run.cycles(40)
    assert (run.state, run.is_playing, run.controller.arm.is_at_rest) == (ControlState.ENDED_BY_REQUEST, False, True)


def test_a_request_to_rest_stops_the_arm_and_goes_on() -> None:
    run = Session()
    run.follow(0.005, 50)
    for _ in range(40):
        run.write(ControlRequest.REST, run.start)
        run.cycles(1)
    assert (run.state, run.is_playing, run.controller.arm.is_at_rest) == (ControlState.RUNNING, True, True)
    run.follow(0.001, 50)
    assert not run.controller.arm.is_at_rest


def test_tool_and_payload_are_set_at_rest() -> None:
    run = Session()
    run.follow(0.005, 50)
    settings = (1, [0.0, 0.01, 0.12, 0.0, 0.0, 0.1, 2.5, 0.0, 0.0, 0.04])
    run.write(ControlRequest.FOLLOW, run.controller.arm.q.tolist(), settings=settings)
    run.cycles(1)
    assert run.controller.output_ints[4] == 0
    for _ in range(40):
        run.write(ControlRequest.REST, run.start, settings=settings)
        run.cycles(1)
    assert run.controller.output_ints[4] == 1
    assert run.controller.arm.tcp_offset == settings[1][:6]
    assert (run.controller.payload_kg, run.controller.payload_cog_m) == (2.5, (0.0, 0.0, 0.04))


def test_outputs_are_set_once_each() -> None:
    run = Session()
    run.follow(0.0, 1, output=(1, 3, 1))
    assert run.controller.digital_outputs == 0
    run.follow(0.0, 1, output=(1, 3, 1))
    run.follow(0.0, 2, output=(2, 9, 1))
    assert run.controller.digital_outputs == 1 << 3 | 1 << 17
    # Somebody else turns it off; the old request is not repeated.
    run.controller.set_digital_outputs(1 << 3, 0)
    run.follow(0.0, 3, output=(2, 9, 1))
    assert run.controller.digital_outputs == 1 << 17
    run.follow(0.0, 2, output=(3, 9, 0))
    assert (run.controller.digital_outputs, run.controller.output_ints[5]) == (0, 3)


def test_the_registers_of_the_program_are_those_of_the_driver() -> None:
    source = PROGRAM.read_text(encoding="utf-8")
    assert {int(number) for number in re.findall(r"read_input_integer_register\((\d+)\)", source)} == set(
        range(INPUT_INTS)
    )
    assert {int(number) for number in re.findall(r"read_input_float_register\((\d+)\)", source)} == set(
        range(INPUT_DOUBLES)
    )
    assert {int(number) for number in re.findall(r"write_output_integer_register\((\d+)", source)} == set(
        range(OUTPUT_INTS)
    )
    assert len(INPUTS) == len(INPUT_TYPES) == INPUT_INTS + INPUT_DOUBLES
