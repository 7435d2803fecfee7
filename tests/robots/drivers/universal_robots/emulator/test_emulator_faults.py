"""What the client library of others sees of stops, refusals and broken links, and what is needed to go on."""

from __future__ import annotations

import math
import random
import socket
from contextlib import suppress

import pytest

from tests.robots.drivers.universal_robots.client_library import ClientLibrary, LibraryError, needs_client_library
from tests.robots.drivers.universal_robots.emulated_controller import EmulatedController

pytestmark = needs_client_library
FAR = [2.5, -math.pi / 2, math.pi / 2, -math.pi / 2, -math.pi / 2, 0.0]
NEAR = [0.2, -math.pi / 2, math.pi / 2, -math.pi / 2, -math.pi / 2, 0.0]


def test_a_protective_stop_ends_a_motion_and_is_unlocked_after_five_seconds() -> None:
    """Not earlier; then the script is uploaded again, and the arm moves."""
    with (
        EmulatedController() as controller,
        ClientLibrary(controller.host, "receive", "dashboard", "control") as client,
    ):
        client.call("dashboard.connect")
        client.send("control.moveJ", FAR, 0.8, 2.0)
        controller.wait("moving")
        controller.ask("protective_stop")
        assert client.receive() is False
        state = controller.wait("at_rest")
        assert 0.0 < state["q"][0] < FAR[0]
        assert state["safety_mode"] == "PROTECTIVE_STOP"
        client.until("receive.isProtectiveStopped")
        assert client.call("receive.getSafetyMode") == 3
        assert client.call("dashboard.safetystatus") == "Safetystatus: PROTECTIVE_STOP"
        with pytest.raises(LibraryError, match="Cannot unlock protective stop until 5s after occurrence"):
            client.call("dashboard.unlockProtectiveStop")
        assert controller.state()["safety_mode"] == "PROTECTIVE_STOP"
        controller.wait("unlockable")
        client.call("dashboard.unlockProtectiveStop")
        assert controller.state()["safety_mode"] == "NORMAL"
        assert client.call("control.reuploadScript") is True
        client.until("control.isProgramRunning")
        assert client.call("control.moveJ", NEAR, 1.0, 4.0) is True
        assert controller.state()["q"] == pytest.approx(NEAR)


def test_the_library_itself_can_ask_for_a_protective_stop() -> None:
    """Through a function of URScript."""
    with EmulatedController() as controller, ClientLibrary(controller.host, "control") as client:
        client.call("control.triggerProtectiveStop")
        assert controller.wait("stopped")["safety_mode"] == "PROTECTIVE_STOP"


def test_an_emergency_stop_takes_the_power_and_needs_power_and_brakes_again() -> None:
    """Releasing the button alone moves nothing."""
    with (
        EmulatedController() as controller,
        ClientLibrary(controller.host, "receive", "dashboard", "control") as client,
    ):
        client.call("dashboard.connect")
        client.send("control.moveJ", FAR, 0.8, 2.0)
        controller.wait("moving")
        controller.ask("emergency_stop")
        assert client.receive() is False
        client.until("receive.isEmergencyStopped")
        client.call("dashboard.powerOn")
        assert controller.state()["robot_mode"] == "POWER_OFF"
        controller.ask("release_emergency_stop")
        assert controller.state()["robot_mode"] == "POWER_OFF"
        client.call("dashboard.powerOn")
        assert client.call("dashboard.robotmode") == "Robotmode: IDLE"
        client.call("dashboard.brakeRelease")
        assert client.call("dashboard.robotmode") == "Robotmode: RUNNING"
        client.call("control.reuploadScript")
        client.until("control.isProgramRunning")
        assert client.call("control.moveJ", NEAR, 1.0, 4.0) is True


def test_the_dashboard_stops_a_motion_that_blocks_the_library() -> None:
    """On a connection of its own, as a driver has to."""
    with EmulatedController() as controller, ClientLibrary(controller.host, "control") as client:
        client.send("control.moveJ", FAR, 0.5, 2.0)
        controller.wait("moving")
        with (
            socket.create_connection((controller.host, 29999), timeout=30) as dashboard,
            dashboard.makefile("rw") as lines,
        ):
            assert lines.readline() == "Connected: Universal Robots Dashboard Server\n"
            lines.write("stop\n")
            lines.flush()
            assert lines.readline() == "Stopped\n"
        assert client.receive() is False
        assert controller.wait("at_rest")["q"][0] < 2.0


def test_a_controller_in_local_control_refuses_programs() -> None:
    """An e-Series controller says whether it is in remote control, and the library asks."""
    with EmulatedController(series="e", model="ur10e") as controller:
        controller.ask("remote", value=0)
        with ClientLibrary(controller.host) as client, pytest.raises(LibraryError, match="enable remote control"):
            client.call("control.open")
        controller.ask("remote", value=1)
        with ClientLibrary(controller.host, "control") as client:
            assert client.call("control.moveJ", NEAR, 1.0, 4.0) is True
            assert client.call("control.isSteady") is True
        assert controller.state()["q"] == pytest.approx(NEAR)


def test_a_link_that_is_cut_takes_no_new_connection_and_the_program_goes_on() -> None:
    """As on a controller: without a watchdog nobody stops the arm."""
    with EmulatedController() as controller:
        with ClientLibrary(controller.host, "control") as client:
            assert client.call("control.moveJ", FAR, 0.8, 4.0, True) is True
            controller.wait("moving")
            controller.ask("cut")
            with socket.create_connection((controller.host, 30004), timeout=30) as link:
                assert is_closed(link)
            state = controller.wait("at_rest")
        assert state["q"] == pytest.approx(FAR)
        assert state["connections"] == 0
        controller.ask("restore")
        with ClientLibrary(controller.host, "control") as client:
            assert client.call("control.moveJ", NEAR, 2.0, 8.0) is True


def is_closed(link: socket.socket) -> bool:
    """Whether the other side has closed a connection, or dropped it."""
    try:
        return link.recv(1) == b""
    except ConnectionResetError:
        return True


def test_a_controller_that_hangs_sends_the_same_time_for_ever() -> None:
    """The library goes on to say that it is connected: freshness is what a driver has to look at."""
    with EmulatedController() as controller, ClientLibrary(controller.host, "receive") as client:
        controller.ask("freeze")
        frozen_s = controller.state()["time_s"]
        assert client.call("receive.getTimestamp") <= frozen_s + 1e-9
        assert client.call("receive.isConnected") is True
        controller.ask("restore")
        with ClientLibrary(controller.host, "control") as other:
            assert other.call("control.moveJ", NEAR, 1.0, 4.0) is True
        assert controller.state()["time_s"] > frozen_s


def test_a_slow_link_delays_each_answer() -> None:
    """By the clock of the controller, which goes on meanwhile."""
    with (
        EmulatedController() as controller,
        socket.create_connection((controller.host, 29999), timeout=30) as dashboard,
        dashboard.makefile("rw") as lines,
    ):
        lines.readline()
        controller.ask("slow", value=0.3)
        before_s = controller.state()["time_s"]
        lines.write("robotmode\n")
        lines.flush()
        assert lines.readline() == "Robotmode: RUNNING\n"
        assert controller.state()["time_s"] - before_s > 0.25


def test_a_motion_ends_at_a_contact() -> None:
    """In functions of URScript that only e-Series controllers have."""
    with (
        EmulatedController(series="e", model="ur5e") as controller,
        ClientLibrary(controller.host, "control") as client,
    ):
        start_m = controller.state()["tcp_pose"][2]
        client.send("control.moveUntilContact", [0.0, 0.0, -0.05, 0.0, 0.0, 0.0])
        controller.wait("moving")
        controller.ask("contact", value=1)
        assert client.receive() is True
        assert controller.wait("at_rest")["tcp_pose"][2] < start_m


def test_garbage_on_any_port_moves_nothing_and_the_next_client_is_served() -> None:
    """Bytes of any kind, with and without line ends."""
    with EmulatedController() as controller:
        before = controller.state()
        for port in (29900, 29999, 30001, 30002, 30003, 30004):
            for seed in range(4):
                source = random.Random(seed)
                with socket.create_connection((controller.host, port), timeout=30) as connection:
                    with suppress(ConnectionError):
                        connection.sendall(
                            source.randbytes(30_000) + b"\n" + bytes(source.choices(range(128), k=5_000))
                        )
                    connection.shutdown(socket.SHUT_WR)
                    with suppress(ConnectionError):
                        while connection.recv(65_536):
                            pass
        assert controller.state()["q"] == before["q"]
        with ClientLibrary(controller.host, "control") as client:
            assert client.call("control.moveJ", NEAR, 1.0, 4.0) is True
