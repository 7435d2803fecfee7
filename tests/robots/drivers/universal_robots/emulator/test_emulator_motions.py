"""The client library of others moves the emulated arm, through the script that it uploads itself."""

from __future__ import annotations

import math
from collections.abc import Generator

import pytest

from robots.drivers.universal_robots.emulator.pose_vectors import rotation_of
from tests.robots.drivers.universal_robots.client_library import ClientLibrary, LibraryError, needs_client_library
from tests.robots.drivers.universal_robots.emulated_controller import EmulatedController

pytestmark = needs_client_library
HOME = [0.0, -math.pi / 2, math.pi / 2, -math.pi / 2, -math.pi / 2, 0.0]
TURNED = [0.4, -math.pi / 2, math.pi / 2, -math.pi / 2, -math.pi / 2, 0.0]


@pytest.fixture(scope="module")
def controller() -> Generator[EmulatedController]:
    """One controller for all tests of this file: each begins with a motion to where it needs the arm."""
    with EmulatedController() as emulated:
        yield emulated


@pytest.fixture(scope="module")
def client(controller: EmulatedController) -> Generator[ClientLibrary]:
    """One client of it."""
    with ClientLibrary(controller.host, "receive", "control") as library:
        yield library


def move_to(client: ClientLibrary, q: list[float]) -> None:
    """Move, and see that the library reports success."""
    assert client.call("control.moveJ", q, 2.0, 8.0) is True


def test_a_joint_motion_ends_at_its_target_at_rest(controller: EmulatedController, client: ClientLibrary) -> None:
    """As the library reads it, and as it is."""
    move_to(client, TURNED)
    move_to(client, HOME)
    assert controller.state()["q"] == pytest.approx(HOME, abs=1e-9)
    assert controller.state()["qd"] == [0.0] * 6
    client.until_that("receive.getActualQ", lambda q: q == pytest.approx(HOME, abs=1e-9))


def test_a_linear_motion_ends_at_its_pose(controller: EmulatedController, client: ClientLibrary) -> None:
    """To far less than a micrometre."""
    move_to(client, HOME)
    pose = controller.state()["tcp_pose"]
    target = [pose[0], pose[1] + 0.05, pose[2] + 0.08, *pose[3:]]
    assert client.call("control.moveL", target, 0.5, 2.0) is True
    assert controller.state()["tcp_pose"] == pytest.approx(target, abs=1e-8)


def test_an_asynchronous_motion_reports_progress_and_is_stopped(
    controller: EmulatedController, client: ClientLibrary
) -> None:
    """It is under way while the call has returned, and `stopJ` brings it to rest on its path."""
    move_to(client, HOME)
    assert client.call("control.moveJ", [1.5, *HOME[1:]], 0.5, 2.0, True) is True
    client.until_that("control.getAsyncOperationProgress", lambda progress: progress >= 0)
    client.call("control.stopJ", 4.0)
    state = controller.wait("at_rest")
    assert 0.0 < state["q"][0] < 1.4
    client.until_that("control.getAsyncOperationProgress", lambda progress: progress < 0)


def test_streamed_set_points_are_reached(controller: EmulatedController, client: ClientLibrary) -> None:
    """`servoJ` follows with a lag, and comes to rest where it is told to stop."""
    move_to(client, HOME)
    client.call("servo", HOME, [0.002, 0.0, 0.0, 0.0, 0.0, 0.0], 60, 0.008)
    assert client.call("control.servoStop", 10.0) is True
    state = controller.wait("at_rest")
    assert 0.03 < state["q"][0] <= 0.12
    assert state["q"][1:] == pytest.approx(HOME[1:], abs=1e-3)


def test_joint_velocities_are_held_until_stopped(controller: EmulatedController, client: ClientLibrary) -> None:
    """`speedJ` goes on without further calls, as the script repeats it."""
    move_to(client, HOME)
    client.call("control.speedJ", [0.2, 0.0, 0.0, 0.0, 0.0, 0.0], 4.0, 0.0)
    controller.wait("moving")
    assert client.call("control.speedStop", 4.0) is True
    assert controller.wait("at_rest")["q"][0] > 0.0


def test_tool_velocities_move_on_a_line(controller: EmulatedController, client: ClientLibrary) -> None:
    """`speedL` upwards changes neither the other coordinates nor the orientation."""
    move_to(client, HOME)
    before = controller.state()["tcp_pose"]
    client.call("control.speedL", [0.0, 0.0, 0.1, 0.0, 0.0, 0.0], 2.0, 0.0)
    controller.wait("moving")
    assert client.call("control.speedStop", 4.0) is True
    after = controller.wait("at_rest")["tcp_pose"]
    assert after[2] > before[2]
    assert after[:2] == pytest.approx(before[:2], abs=1e-3)
    # Half a turn has two rotation vectors.
    assert rotation_of(after[3:]) == pytest.approx(rotation_of(before[3:]), abs=1e-3)


def test_inverse_and_forward_kinematics_agree(controller: EmulatedController, client: ClientLibrary) -> None:
    """The joints for a pose put the flange there; with a tool, the tool is before the flange."""
    move_to(client, HOME)
    pose = controller.state()["tcp_pose"]
    target = [pose[0] + 0.1, *pose[1:]]
    q = client.call("control.getInverseKinematics", target)
    tool = client.call("control.getForwardKinematics", q, [0.0, 0.0, 0.1, 0.0, 0.0, 0.0])
    # The flange of this configuration looks down.
    assert tool[:3] == pytest.approx([target[0], target[1], target[2] - 0.1], abs=1e-6)
    assert rotation_of(tool[3:]) == pytest.approx(rotation_of(target[3:]), abs=1e-6)


def test_payload_and_tool_centre_point_are_set(controller: EmulatedController, client: ClientLibrary) -> None:
    """And the tool centre point is read back."""
    move_to(client, HOME)
    flange = controller.state()["tcp_pose"]
    assert client.call("control.setPayload", 2.5, [0.0, 0.0, 0.05]) is True
    assert client.call("control.setTcp", [0.0, 0.0, 0.2, 0.0, 0.0, 0.0]) is True
    state = controller.state()
    offset = client.call("control.getTCPOffset")
    assert client.call("control.setTcp", [0.0] * 6) is True
    assert state["payload_kg"] == 2.5
    assert state["tcp_pose"][2] == pytest.approx(flange[2] - 0.2, abs=1e-9)
    assert offset == pytest.approx([0.0, 0.0, 0.2, 0.0, 0.0, 0.0])


def test_a_pose_out_of_reach_ends_the_program_without_motion() -> None:
    """The library says no more than False; the controller says why."""
    with EmulatedController() as other, ClientLibrary(other.host, "control") as library:
        assert library.call("control.moveL", [3.0, 0.0, 0.5, 0.0, 3.0, 0.0], 0.25, 1.2) is False
        state = other.wait("stopped")
    assert state["q"] == pytest.approx(HOME)
    assert "program rtde_control ended: the target of movel has no inverse kinematics" in state["messages"]


def test_outputs_inputs_and_the_speed_slider(controller: EmulatedController, client: ClientLibrary) -> None:
    """Outputs are read back as bits; a slower slider stretches a motion."""
    move_to(client, HOME)
    with ClientLibrary(controller.host, "io", "receive") as outputs:
        assert outputs.call("io.setStandardDigitalOut", 3, True) is True
        assert outputs.call("io.setToolDigitalOut", 1, True) is True
        assert outputs.call("io.setConfigurableDigitalOut", 0, True) is True
        controller.ask("digital_input", bit=5, value=1)
        assert outputs.call("io.setSpeedSlider", 0.5) is True
        # A motion later all of it has passed through the controller.
        begin_s = controller.state()["time_s"]
        move_to(client, TURNED)
        slow_s = controller.state()["time_s"] - begin_s
        state = controller.state()
        outputs.until_that("receive.getActualDigitalOutputBits", lambda bits: bits == 1 << 3 | 1 << 17 | 1 << 8)
        outputs.until("receive.getDigitalInState", 5)
        outputs.call("io.setSpeedSlider", 1.0)
        outputs.call("io.setStandardDigitalOut", 3, False)
    assert state["speed_fraction"] == 0.5
    # 0.4 rad at most 2 rad/s and 8 rad/s²: 0.45 s at full speed.
    assert slow_s > 0.8


def test_a_program_of_ones_own_is_executed(controller: EmulatedController, client: ClientLibrary) -> None:
    """Sent through the library; afterwards its own script runs again."""
    move_to(client, HOME)
    body = 'textmsg("of my own")\nmovej([0.1, -1.57, 1.57, -1.57, -1.57, 0.0], a=8, v=2)\nset_digital_out(9, True)'
    assert client.call("control.sendCustomScriptFunction", "own", body) is True
    state = controller.state()
    assert state["q"][0] == pytest.approx(0.1)
    assert "of my own" in state["messages"]
    assert state["digital_outputs"] >> 17 & 1
    move_to(client, HOME)


def test_a_path_of_waypoints_is_executed(controller: EmulatedController, client: ClientLibrary) -> None:
    """The library writes it into its script."""
    move_to(client, HOME)
    path = [[*q, 2.0, 8.0, 0.0] for q in (TURNED, HOME, TURNED)]
    assert client.call("control.moveJ", path) is True
    # It writes four decimals.
    assert controller.wait("at_rest")["q"] == pytest.approx(TURNED, abs=1e-4)


def test_the_watchdog_stops_an_arm_whose_client_is_silent() -> None:
    """It moves while it is kicked, and comes to rest soon after the last kick."""
    with EmulatedController() as other, ClientLibrary(other.host, "control") as library:
        assert library.call("control.setWatchdog", 10.0) is True
        assert library.call("control.moveJ", [3.0, *HOME[1:]], 0.8, 4.0, True) is True
        assert library.call("kick", 60) == 60
        kicked = other.state()
        rest = other.wait("at_rest")
    assert "watchdog of input_int_register_0: stop" in rest["messages"]
    assert kicked["q"][0] > 0.1
    assert kicked["q"][0] <= rest["q"][0] < 2.9
    # A tenth of a second without a kick, and the braking from 0.8 rad/s.
    assert rest["time_s"] - kicked["time_s"] < 0.3


def test_a_second_control_client_is_refused(controller: EmulatedController, client: ClientLibrary) -> None:
    """Its input registers have an owner, and the first client's motions go on."""
    move_to(client, HOME)
    with (
        ClientLibrary(controller.host) as second,
        pytest.raises(LibraryError, match="RTDE input registers are already in use"),
    ):
        second.call("control.open")
    move_to(client, TURNED)
