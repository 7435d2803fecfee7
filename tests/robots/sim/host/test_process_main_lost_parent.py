"""However the engine's process ends or whatever it says: the world's process first brings everything to rest."""

from __future__ import annotations

import os
import socket
import subprocess
import time
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass

import msgspec
import pytest

from engine.host.child_process import start_child
from robots.control.commanding.arm_commands import FollowTrajectory
from robots.io.framing import frame_payload
from robots.io.message_codec import encode_payload
from robots.io.message_socket import MessageSocket
from robots.port import Tolerance
from robots.port.heartbeat import Heartbeat, new_heartbeat_file
from robots.port.shared_file import new_shared_file
from robots.sim.host.world_messages import BuildWorld, FromWorld, ToWorld, WorldReady
from tests.robots.sim.sim_cell import HOME, one_arm, smooth

_PATIENCE_S = 60.0


def follow(motion: int) -> bytes:
    """Return the command to follow a long motion, as a frame."""
    trajectory = smooth(HOME, HOME + 1.0, 10.0)
    command = FollowTrajectory(arm="left", motion=motion, trajectory=trajectory, tolerance=Tolerance())
    return frame_payload(encode_payload(command))


@dataclass(frozen=True)
class World:
    """The process of a world with one arm, and what its parent holds of it."""

    process: subprocess.Popen[bytes]
    connection: socket.socket
    heartbeat: Heartbeat

    def move(self) -> None:
        """Begin a long motion and return when the arm moves."""
        self.connection.sendall(follow(1))
        self.until(moves=True)

    def until(self, *, moves: bool) -> None:
        """Wait until the world itself tells that something moves, or that nothing does."""
        deadline_s = time.monotonic() + _PATIENCE_S
        while bool(self.heartbeat.at_rest_since_ns) is moves:
            assert time.monotonic() < deadline_s
            os.sched_yield()


@contextmanager
def moving_world() -> Generator[World]:
    """Start the process as its parent does, and a motion."""
    ours, theirs = socket.socketpair()
    files = (new_shared_file("state"), new_shared_file("timing"), new_heartbeat_file())
    code = "from robots.sim.host.process_main import main; main()"
    process = start_child(code, (theirs.fileno(), *files), what="the world's process")
    theirs.close()
    try:
        world = World(process, ours, Heartbeat(files[-1]))
        parent = MessageSocket[FromWorld, ToWorld](ours, FromWorld)
        parent.send(BuildWorld(scene=one_arm()), number=1)
        number, ready = parent.wait()
        assert (number, type(ready)) == (1, WorldReady)
        world.move()
        yield world
    finally:
        process.kill()
        process.wait()
        ours.close()
        for file in files:
            os.close(file)


def test_a_parent_that_dies_with_messages_unread_leaves_nothing_moving() -> None:
    """The system then resets the connection, which is no ordinary end."""
    with moving_world() as world:
        # The refusal of a second motion stays unread.
        world.connection.sendall(follow(2))
        while not world.connection.recv(1, socket.MSG_PEEK):
            os.sched_yield()
        world.connection.close()
        world.until(moves=False)
        assert world.process.wait(_PATIENCE_S) == 0


@pytest.mark.parametrize(
    "nonsense",
    [
        pytest.param(b"\xff" * 64, id="length"),
        pytest.param(frame_payload(msgspec.msgpack.encode({"command": "fly"})), id="unknown"),
        pytest.param(frame_payload(b"\xc1"), id="no message", marks=pytest.mark.nightly),
        pytest.param(frame_payload(b""), id="empty", marks=pytest.mark.nightly),
        pytest.param(b"\x00" * 4096, id="zeros", marks=pytest.mark.nightly),
    ],
)
def test_a_parent_that_talks_nonsense_leaves_nothing_moving(nonsense: bytes) -> None:
    with moving_world() as world:
        world.connection.sendall(nonsense)
        world.until(moves=False)
        assert world.process.wait(_PATIENCE_S) != 0
