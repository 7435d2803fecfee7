"""The emulated controller without sockets: downloads, execution, aborts and what switches it off."""

from __future__ import annotations

import numpy as np
import pytest

from robots.drivers.abb.emulation.controller_sessions import (
    EmulatedGripperSwitch,
    GripperSession,
    MotionSession,
    SessionClosed,
)
from robots.drivers.abb.emulation.emulated_controller import EmulatedController
from robots.drivers.abb.emulation.joint_path import InterpolatedPath
from robots.drivers.abb.simple_message import (
    END_DOWNLOAD,
    START_DOWNLOAD,
    STOP,
    CommType,
    Frame,
    OperatingMode,
    SimpleMessageCodec,
    TrajectoryPoint,
    Tristate,
)
from robots.drivers.emulation.kinematic_joints import KinematicJoints
from robots.drivers.emulation.wire_faults import WireFaults
from robots.port import Array

CODEC = SimpleMessageCodec()


class ControllerInTest:
    """A controller at zero, with a clock of the test."""

    def __init__(self) -> None:
        self.now_s = 0.0
        self.controller = EmulatedController(lambda: self.now_s, axes=np.zeros(6), stop_s=0.2)

    def send(self, *points: tuple[int, float, float]) -> None:
        """Send points: sequence, angle of all axes, duration."""
        for sequence, angle, duration_s in points:
            joints = (*(angle,) * 6, *(0.0,) * 4)
            self.controller.take(TrajectoryPoint(sequence=sequence, joints_rad=joints, duration_s=duration_s))

    def angle_at(self, now_s: float) -> float:
        """Let time pass and return the first axis."""
        self.now_s = now_s
        self.controller.advance()
        return float(self.controller.axes[0])


def moving() -> ControllerInTest:
    """A second of a motion over two seconds to 0.4 rad has passed."""
    device = ControllerInTest()
    device.send((START_DOWNLOAD, 0.0, 0.1), (END_DOWNLOAD, 0.4, 2.0))
    assert device.angle_at(1.05) == pytest.approx(0.2, abs=0.01)
    return device


def test_the_last_point_starts_the_motion_and_each_takes_its_duration() -> None:
    device = ControllerInTest()
    device.send((START_DOWNLOAD, 0.0, 9.0), (1, 0.2, 1.0))
    assert device.angle_at(5.0) == 0.0
    device.send((END_DOWNLOAD, 0.4, 2.0))
    assert device.controller.status().in_motion is Tristate.NO
    assert device.angle_at(5.55) == pytest.approx(0.1, abs=0.005)
    assert device.controller.status().in_motion is Tristate.YES
    assert device.angle_at(7.05) == pytest.approx(0.3, abs=0.005)
    assert device.angle_at(8.2) == pytest.approx(0.4, abs=1e-9)
    assert device.controller.status().in_motion is Tristate.NO


def test_the_first_point_is_skipped_only_within_a_tenth_of_a_degree() -> None:
    near, far = ControllerInTest(), ControllerInTest()
    near.send((START_DOWNLOAD, 0.0017, 5.0), (END_DOWNLOAD, 0.4, 1.0))
    far.send((START_DOWNLOAD, 0.0018, 5.0), (END_DOWNLOAD, 0.4, 1.0))
    assert near.angle_at(1.2) == pytest.approx(0.4)
    assert far.angle_at(1.2) < 0.0018
    assert far.angle_at(6.2) == pytest.approx(0.4)


def test_points_beyond_a_hundred_are_dropped_with_a_warning_and_the_last_one_of_them_starts() -> None:
    device = ControllerInTest()
    device.send((START_DOWNLOAD, 0.0, 0.1), *((number, 0.001 * number, 0.1) for number in range(1, 100)))
    assert device.controller.warnings == []
    device.send((100, 3.0, 0.1), (END_DOWNLOAD, 3.0, 0.1))
    assert device.controller.warnings == ["too many trajectory points: 100 at most, a further one was dropped"] * 2
    assert device.angle_at(30.0) == pytest.approx(0.099)


def test_a_stop_brakes_on_the_path_and_clears_it() -> None:
    device = moving()
    device.send((STOP, 0.0, 0.0))
    assert device.angle_at(1.1) > 0.2
    rest = device.angle_at(1.3)
    assert rest == pytest.approx(0.2 + 0.2 * 0.2 / 2.0, abs=0.01)
    assert device.controller.status().in_motion is Tristate.NO
    assert device.angle_at(9.0) == rest


def test_a_stop_drops_a_download_that_is_not_complete() -> None:
    device = ControllerInTest()
    device.send((START_DOWNLOAD, 0.0, 0.1), (1, 0.3, 0.5), (STOP, 0.0, 0.0), (END_DOWNLOAD, 0.1, 0.5))
    assert device.angle_at(9.0) == pytest.approx(0.1)


def test_a_new_trajectory_aborts_the_running_one_and_begins_at_rest() -> None:
    device = moving()
    device.send((START_DOWNLOAD, 0.2, 0.1), (END_DOWNLOAD, 0.0, 1.0))
    assert device.angle_at(1.15) > 0.2
    assert device.angle_at(5.0) == pytest.approx(0.0)
    assert device.controller.started == 2


@pytest.mark.parametrize("how", ["e_stopped", "drives_on", "program_runs", "mode", "error_code"])
def test_whatever_switches_it_off_stops_it_and_the_program_goes_on_when_it_is_started(how: str) -> None:
    device = moving()
    values = {"e_stopped": True, "mode": OperatingMode.MANUAL, "error_code": 7}
    setattr(device.controller, how, values.get(how, False))
    stopped = device.angle_at(1.5)
    assert stopped < 0.3
    assert device.angle_at(3.0) == stopped
    assert device.controller.status().in_motion is Tristate.NO
    device.controller.go_on()
    assert device.angle_at(9.0) == pytest.approx(0.4)


def test_after_a_stop_request_nothing_goes_on_when_it_is_started() -> None:
    device = moving()
    device.controller.e_stopped = True
    stopped = device.angle_at(2.0)
    device.send((STOP, 0.0, 0.0))
    device.controller.go_on()
    assert device.angle_at(9.0) == pytest.approx(stopped, abs=1e-12)


@pytest.mark.parametrize(("angle", "duration_s"), [(float("nan"), 1.0), (9.0, 1.0), (0.1, 0.0), (0.1, float("inf"))])
def test_an_impossible_target_aborts_the_trajectory_with_a_warning(angle: float, duration_s: float) -> None:
    device = ControllerInTest()
    device.send((START_DOWNLOAD, 0.0, 0.1), (END_DOWNLOAD, angle, duration_s))
    assert device.angle_at(5.0) == 0.0
    (warning,) = device.controller.warnings
    assert warning.startswith("motion error")


def test_axes_move_no_faster_than_they_can() -> None:
    device = ControllerInTest()
    device.send((START_DOWNLOAD, 0.0, 0.1), (END_DOWNLOAD, 3.05, 0.1))
    assert device.angle_at(0.55) == pytest.approx(3.05 * 0.5, abs=0.05)


def test_corners_are_rounded_and_the_end_is_exact() -> None:
    path = InterpolatedPath(np.zeros(1), [np.array([0.1]), np.array([0.0])], [1.0, 1.0])
    assert path.at(0.5).tolist() == pytest.approx([0.05])
    assert 0.09 < path.at(1.0)[0] < 0.1
    assert path.at(2.0).tolist() == [0.0]
    steps = np.diff([path.at(time_s)[0] for time_s in np.linspace(0.0, 2.0, 2001)])
    assert np.abs(np.diff(steps)).max() < 3e-6


def test_the_motion_server_replies_to_requests_only_and_drops_other_messages() -> None:
    device = ControllerInTest()
    session = MotionSession(device.controller, WireFaults(), byte_order="little")
    stop = TrajectoryPoint(sequence=STOP, joints_rad=(0.0,) * 10, duration_s=0.0)
    assert session.feed(CODEC.encode_point(stop)).hex(" ") == "0c 00 00 00 0b 00 00 00 03 00 00 00 01 00 00 00"
    assert session.feed(CODEC.encode_point(stop, comm=CommType.TOPIC)) == b""
    with pytest.raises(SessionClosed, match="message of type 10"):
        session.feed(CODEC.encode_frame(Frame(kind=10, comm=1, data=bytes(44))))
    with pytest.raises(SessionClosed, match="no TRAJECTORY_POINT"):
        session.feed(CODEC.encode_frame(Frame(kind=11, comm=2, data=bytes(51))))


def test_the_gripper_program_knows_two_texts() -> None:
    gripper = EmulatedGripperSwitch("done")
    session = GripperSession(gripper)
    assert (session.feed(b"gripperON"), gripper.on) == (b"done", True)
    assert (session.feed(b"gripper"), gripper.on) == (b"", True)
    assert (session.feed(b"gripperOFF\n"), gripper.on) == (b"done", False)


class LaggingAxes(KinematicJoints):
    """Axes that are a little behind, and that a test can block."""

    carried_kg = 0.0

    def carry(self, mass_kg: float) -> None:
        """Note the load."""
        self.carried_kg = mass_kg

    def measured(self) -> tuple[Array, Array]:
        """Return axes that sag by a milliradian."""
        position, velocity = super().measured()
        return position - 0.001, velocity

    def reset(self) -> None:
        """Follow again."""
        self.problem = ""


def test_axes_of_a_world_are_measured_and_their_problem_is_one_of_motion_supervision() -> None:
    axes = LaggingAxes(np.zeros(6))
    now_s = 0.0
    controller = EmulatedController(lambda: now_s, axes=np.ones(6), stop_s=0.2, plant=axes, load_kg=5.0)
    for sequence, angle in ((START_DOWNLOAD, 0.0), (END_DOWNLOAD, 0.4)):
        joints = (*(angle,) * 6, *(0.0,) * 4)
        controller.take(TrajectoryPoint(sequence=sequence, joints_rad=joints, duration_s=1.0))
    now_s = 0.6
    assert controller.joint_position().joints_rad[0] == pytest.approx(controller.axes[0] - 0.001)
    assert (axes.carried_kg, controller.in_motion) == (5.0, True)
    axes.problem = "joint_2 is 0.2 rad behind"
    now_s = 0.8
    status = controller.status()
    assert (status.error_code, status.motion_possible, controller.in_motion) == (50204, Tristate.NO, False)
    assert controller.warnings == ["motion supervision: joint_2 is 0.2 rad behind"]
    stopped_rad = controller.joint_position().joints_rad[0]
    controller.go_on()
    now_s = 3.0
    assert (controller.status().error_code, controller.status().motion_possible) == (0, Tristate.YES)
    assert controller.axes[0] == pytest.approx(stopped_rad)


def test_a_gripper_text_turns_output_0_of_the_on_output() -> None:
    heard: list[tuple[int, bool]] = []

    def on_output(output: int, *, on: bool) -> None:
        heard.append((output, on))

    session = GripperSession(EmulatedGripperSwitch("ok", on_output))
    assert (session.feed(b"gripperON"), session.feed(b"nothing"), session.feed(b"gripperOFF")) == (b"ok", b"", b"ok")
    assert heard == [(0, True), (0, False)]
