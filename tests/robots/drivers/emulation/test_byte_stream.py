"""Answers that the wire delays keep their order."""

from __future__ import annotations

import asyncio

from robots.drivers.emulation.byte_stream import deliver
from robots.drivers.emulation.wire_faults import WireFaults


def test_late_answers_keep_their_order() -> None:
    async def sent() -> list[bytes]:
        faults, written = WireFaults(), list[bytes]()
        done = asyncio.get_running_loop().create_future()

        def write(message: bytes) -> None:
            written.append(message)
            if message == b"last":
                done.set_result(None)

        for number, slow_s in enumerate((0.05, 0.02, 0.0, 0.0)):
            faults.slow_s = slow_s
            deliver(b"%d" % number, faults, write)
        deliver(b"last", faults, write)
        await done
        deliver(b"again", faults, write)
        return written

    assert asyncio.run(sent()) == [b"0", b"1", b"2", b"3", b"last", b"again"]
