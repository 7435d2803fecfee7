"""The script port is never waited for: what it does not take has a name, and what it takes arrives whole."""

from __future__ import annotations

import socket
import time
from collections.abc import Generator
from contextlib import ExitStack, contextmanager

import numpy as np
import pytest

from robots.drivers.universal_robots.script_port import ScriptPort
from robots.drivers.universal_robots.ur_joint_controller import UrJointController
from robots.drivers.universal_robots.ur_options import UrOptions
from tests.robots.own_address import own_address

LIMIT_S = 20.0
PROGRAM = "sec one():\n  sync()\nend\n"


@contextmanager
def full_port(host: str, port: int) -> Generator[None]:
    """A port that answers no connection: its queue is full, and the kernel drops what comes."""
    with ExitStack() as sockets:
        listener = sockets.enter_context(socket.socket())
        listener.bind((host, port))
        listener.listen(0)
        for _ in range(3):
            client = sockets.enter_context(socket.socket())
            client.setblocking(False)
            client.connect_ex((host, port))
        yield


def until_problem(port: ScriptPort) -> str:
    """Go on until there is a problem, and return it."""
    end_s = time.monotonic() + LIMIT_S
    while not port.problem and time.monotonic() < end_s:
        port.advance()
    return port.problem


def test_an_output_does_not_wait_for_a_port_that_does_not_answer() -> None:
    """Half a period of a CB3 controller of processor time: the machine may be busy, and waiting costs none."""
    host = own_address()
    controller = UrJointController(UrOptions(host=host))
    with full_port(host, 30002):
        shortest_s = LIMIT_S
        for _ in range(5):
            begun_s = time.perf_counter()
            controller.set_output(1, on=True)
            shortest_s = min(shortest_s, time.perf_counter() - begun_s)
        assert shortest_s < 0.05
        assert controller.output_problem == ""
    controller.close()


def test_a_port_that_does_not_answer_is_a_problem_by_name() -> None:
    host = own_address()
    port = ScriptPort(host, 30002, limit_s=0.2)
    with full_port(host, 30002):
        port.send(PROGRAM)
        assert until_problem(port) == "script port 30002: no connection within 0.2 s"
    port.close()


def test_a_port_that_is_not_there_is_a_problem_until_the_next_program() -> None:
    host = own_address()
    port = ScriptPort(host, 30002, limit_s=1.0)
    port.send(PROGRAM)
    assert until_problem(port) == "script port 30002: Connection refused"
    with socket.create_server((host, 30002)) as listener:
        port.send(PROGRAM)
        assert port.problem == ""
        client, _ = listener.accept()
        with client:
            received = b""
            while len(received) < len(PROGRAM):
                port.advance()
                received += client.recv(100)
            assert received.decode() == PROGRAM
    # It has nothing to send any more: that the controller closes it is no problem.
    for _ in range(100):
        port.advance()
    assert port.problem == ""
    port.close()


@pytest.mark.parametrize("output", [-1, 10])
def test_there_are_ten_outputs(output: int) -> None:
    controller = UrJointController(UrOptions(host="127.0.0.254"))
    with pytest.raises(Exception, match=f"there is no output {output}"):
        controller.set_output(output, on=bool(np.True_))
