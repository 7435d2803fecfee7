"""The transport of a SoftHand on its emulator: what a reading says of a command, and answers that come late."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager

import pytest

from robots.drivers.softhand.hand_reading import HandActivation, HandReference
from robots.drivers.softhand.hand_transport import HandTransport
from robots.io.wire.link_error import LinkError
from tests.robots.drivers.emulated_device import EmulatedProcess
from tests.robots.drivers.emulated_hand import HAND_CONNECTIONS, emulated_hand


@contextmanager
def opened(emulator: EmulatedProcess, *, timeout_s: float = 1.0) -> Generator[HandTransport]:
    transport = HandTransport(emulator.serial_device, baud=2_000_000, unit=1, timeout_s=timeout_s)
    transport.open()
    try:
        yield transport
    finally:
        transport.close()


@pytest.mark.parametrize("connection", HAND_CONNECTIONS)
def test_a_command_shows_in_the_next_reading_with_what_the_hand_followed_before(connection: str) -> None:
    """Once: later readings say nothing of it."""
    with emulated_hand(connection) as emulator, opened(emulator) as transport:
        emulator.do("foreign", ticks=700)
        transport.write(HandReference(ticks=100))
        first, second = transport.read(), transport.read()
        assert (first.reference_ticks, first.before_ticks) == (100, 700)
        assert (second.reference_ticks, second.before_ticks) == (100, 100)


@pytest.mark.parametrize("connection", HAND_CONNECTIONS)
def test_a_motor_is_switched_on_and_off(connection: str) -> None:
    with emulated_hand(connection, active=False) as emulator, opened(emulator) as transport:
        assert not transport.read().active
        transport.write(HandActivation(on=True))
        assert transport.read().active
        transport.write(HandActivation(on=False))
        assert not transport.read().active


@pytest.mark.parametrize("connection", HAND_CONNECTIONS)
def test_a_late_answer_is_not_that_of_the_next_request(connection: str) -> None:
    """Frames have no number; after a failure the line is drained."""
    with emulated_hand(connection) as emulator, opened(emulator, timeout_s=0.2) as transport:
        transport.write(HandReference(ticks=100))
        emulator.do("slow", seconds=0.3)
        with pytest.raises(LinkError, match=r"no valid answer to GET_ACTIVATE within 0\.2 s"):
            transport.read()
        emulator.do("restore")
        emulator.do("foreign", ticks=5000)
        transport.close()
        transport.open()
        assert transport.read().reference_ticks == 5000
