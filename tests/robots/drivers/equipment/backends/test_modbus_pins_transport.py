"""Coils and discrete inputs through the real client, against pymodbus's own server."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Generator
from pathlib import Path

import pytest

from engine.document.equipment.equipment_document import EquipmentDocument, ModbusPins
from engine.document.equipment.equipment_file import read_equipment
from robots.drivers.equipment.backends.pin_values import PinCommand
from robots.io.wire.link_error import LinkError
from tests.robots.drivers.equipment.served_equipment import PINS

PLC = """
import asyncio, socket
from pymodbus.server import ModbusTcpServer
from pymodbus.simulator import DataType, SimData, SimDevice
bits = lambda values: [SimData(0, values=values, datatype=DataType.BITS)]
words = [SimData(0, values=[0] * 8, datatype=DataType.REGISTERS)]
device = SimDevice(id=1, simdata=(bits([False] * 64), bits([False] * 27 + [True] + [False] * 36), words, words))
async def main():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    server = ModbusTcpServer(device, address=("127.0.0.1", port))
    await server.serve_forever(background=True)
    print(port, flush=True)
    await asyncio.Event().wait()
asyncio.run(main())
"""


@pytest.fixture
def plc() -> Generator[tuple[subprocess.Popen[str], EquipmentDocument]]:
    """Start a PLC whose discrete input 27 is on."""
    with subprocess.Popen([sys.executable, "-c", PLC], stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            backend = f"{{kind: modbus_tcp, host: 127.0.0.1, port: {process.stdout.readline().strip()}}}"
            text = f"flexcell: 1\nequipment: clamps\nbackend: {backend}\n{PINS}"
            yield process, read_equipment(text, file=Path("clamps.yaml")).document
        finally:
            process.kill()


def test_coils_are_written_and_read_back(plc: tuple[subprocess.Popen[str], EquipmentDocument]) -> None:
    """Opening makes them safe, also after another client has set them; a PLC that is gone is an error."""
    from robots.drivers.equipment.backends.modbus_pins_transport import ModbusPinsTransport

    process, document = plc
    assert isinstance(document.backend, ModbusPins)
    pins = ModbusPinsTransport(document, document.backend)
    pins.open()
    assert pins.read().values == {"clamp": True, "valve": False, "there": True}
    pins.write(PinCommand(values={"clamp": False, "valve": True}))
    assert pins.read().values == {"clamp": False, "valve": True, "there": True}
    pins.close()
    pins.open()
    assert pins.read().values == {"clamp": True, "valve": False, "there": True}
    process.kill()
    process.wait(20.0)
    with pytest.raises(LinkError):
        pins.read()
    pins.close()
