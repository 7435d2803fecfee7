"""Datagrams of the interface in a capture, from either side, and a client on the replay of its server."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.errors import FlexcellError
from robots.drivers.replay.replay_emulator import ReplayOptions
from robots.drivers.replay.serve_replay import serve_replay
from robots.io.wire.read_capture import read_capture
from robots.io.wire.wire_capture import WireCapture
from robots.reconcell import ReconcellClient
from tests.robots.drivers.emulated_device import replayed
from tests.robots.own_address import own_address
from tests.robots.reconcell.primitives_184 import HOME
from tests.robots.reconcell.reconcell_cell import reconcell_cell


@pytest.mark.virtual
async def test_a_client_receives_again_what_its_server_sent(tmp_path: Path) -> None:
    capture = WireCapture(tmp_path, device="ur10")
    served = tmp_path / "served"
    served.mkdir()
    async with reconcell_cell(tmp_path, capture=capture, own_capture=served) as cell:
        cell.client.move_joints(HOME, speed=0.5)
        await cell.at_rest()
        await cell.receive()
        before, flags = cell.client.state, cell.client.flags
    capture.close()
    assert before is not None
    assert flags is not None
    assert flags.finished == 1
    (file,) = tmp_path.glob("ur10.reconcell.*")  # noqa: ASYNC240 - time is virtual
    found = read_capture(file)
    sent = [(each.endpoints.remote[1], each.data) for each in found.events if each.kind == "sent" and each.endpoints]
    assert [(port, len(data)) for port, data in sent] == [(26000, 56), (10000, 1)]
    # The server has captured the same datagrams, as received ones.
    (other,) = served.iterdir()
    assert other.name.startswith("ur10.reconcell_server.")
    received = [each for each in read_capture(other).events if each.kind == "received" and each.endpoints]
    assert [(each.endpoints.local[1], each.data) for each in received if each.endpoints] == sent
    # What it has received are commands: played back, they would move the arm that is served at these ports.
    with pytest.raises(FlexcellError, match="it was captured by the server"):
        await serve_replay(ReplayOptions(file=str(other)), ready=lambda _: None)

    address = own_address()
    with replayed(file, pace=1.0, host=address, receiver=address) as replay:
        with ReconcellClient(address, own=address) as client:
            client.move_joints(HOME, speed=0.5)
            while client.flags != flags or client.state != before:
                client.receive(timeout_s=5.0)
            assert replay.do("state") == {"mismatch": "", "answered": 2, "remaining_commands": 0}
            client.move_joints(HOME, speed=0.4)
            client.stop()
        while not (mismatch := replay.do("state")["mismatch"]):
            pass
        assert str(mismatch).startswith("behind the last command of the capture port 26000: ")
