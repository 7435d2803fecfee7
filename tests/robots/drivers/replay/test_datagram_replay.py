"""A replay of datagrams sends to whom it is told, and to nobody else."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from engine.errors import FlexcellError
from robots.drivers.replay.replay_emulator import ReplayOptions
from robots.drivers.replay.serve_replay import serve_replay
from robots.io.wire.wire_capture import WireCapture
from robots.io.wire.wire_tap import WireEndpoints

CLIENT = WireEndpoints(local=("192.168.1.7", 20010), remote=("192.168.1.5", 20001))


def recorded(folder: Path, *, answers: bool) -> Path:
    """Return the capture of a client that has sent a datagram."""
    capture = WireCapture(folder, device="arm")
    tap = capture.tap("reconcell")
    tap.sent(b"\x01", CLIENT)
    if answers:
        tap.received(b"\x02", CLIENT)
    capture.close()
    (file,) = folder.iterdir()
    return file


def test_a_replay_without_a_receiver_is_refused_with_what_to_say(tmp_path: Path) -> None:
    file = recorded(tmp_path, answers=True)
    with pytest.raises(FlexcellError, match=r"would be sent to 192\.168\.1\.7, the recorded client") as refused:
        asyncio.run(serve_replay(ReplayOptions(file=str(file)), lambda _: None))
    assert refused.value.hint == "name who receives them, for a client on this machine: receiver=127.0.0.1"


@pytest.mark.parametrize(("answers", "receiver"), [(True, "127.0.0.1"), (False, "")])
def test_a_replay_is_served_where_somebody_is_named_or_nothing_is_sent(
    tmp_path: Path, answers: bool, receiver: str
) -> None:
    file = recorded(tmp_path, answers=answers)

    async def served() -> object:
        place: asyncio.Future[object] = asyncio.get_running_loop().create_future()
        options = ReplayOptions(file=str(file), receiver=receiver)
        serving = asyncio.create_task(serve_replay(options, place.set_result))
        await asyncio.wait((serving, place), return_when=asyncio.FIRST_COMPLETED)
        serving.cancel()
        return place.result()

    assert "ports" in str(asyncio.run(served()))
