"""Equipment of a cell at the real server: control, refusals, STOP, cuts of the link, and an engine that hangs."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import cast

import pytest

from engine.bus import SkillBus
from engine.cell.drivers import DeviceReport
from engine.cell.open_cell import OpenCell
from engine.clock import new_clock
from engine.errors import RobotError
from engine.messages.device_state import DeviceState
from engine.skills.digital_outputs import SetOutput
from engine.skills.pwm_outputs import PwmOutputs, SetDutyCycle
from robots.drivers.equipment.configuration_file import ConfigurationFile
from robots.drivers.equipment.device.equipment_device import EquipmentDevice
from robots.drivers.equipment.device.equipment_transport import EquipmentCommand, EquipmentTransport
from robots.drivers.equipment.equipment_server import EquipmentServer
from robots.drivers.equipment.wire.equipment_client import connected
from tests.robots.drivers.equipment.device.equipment_cell import (
    VICE,
    inputs,
    opened,
    outputs,
    switched,
    until,
    written,
)
from tests.robots.drivers.equipment.served_equipment import SIMULATED, served_equipment
from tests.robots.own_address import own_address

WHY = "a test"


def server_of(folder: Path, *, port: int = 0, pins: str = SIMULATED) -> EquipmentServer:
    """Return a server of pins in memory."""
    configuration = ConfigurationFile(folder / "served.yaml")
    configuration.file.write_text(pins, encoding="utf-8")
    return EquipmentServer(configuration, host="127.0.0.1", port=port)


def state_of(cell: OpenCell) -> DeviceState:
    """Return what the vice says of itself."""
    latest = cell.bus.topic(f"{VICE}/device", DeviceState).latest
    assert latest is not None
    return latest


async def test_it_reads_without_control_and_sets_outputs_once_a_person_has_enabled_it(tmp_path: Path) -> None:
    async with server_of(tmp_path) as server, opened(written(tmp_path, port=server.port)) as cell:
        assert outputs(cell.bus) == {"clamp": True, "valve": False}
        assert inputs(cell.bus).names == {"there": 0}
        refused = await switched(cell.bus, "valve", on=True)
        assert (refused.success, "not enabled" in refused.message) == (False, True)
        # Nobody controls yet: another client may.
        await asyncio.to_thread(_control_once, server.port)
        await cell.enable(WHY, by="Ada")
        done = await switched(cell.bus, "valve", on=True)
        assert (done.success, done.message) == (True, "valve is on")
        assert outputs(cell.bus) == {"clamp": True, "valve": True}
        assert (state_of(cell).enabled, state_of(cell).enabled_by) == (True, "Ada")


def _control_once(port: int) -> None:
    with connected("127.0.0.1", port, name="other", control=True):
        pass


async def test_an_output_that_it_does_not_have_is_refused_with_those_that_it_has(tmp_path: Path) -> None:
    async with server_of(tmp_path) as server, opened(written(tmp_path, port=server.port)) as cell:
        await cell.enable(WHY)
        answers = [
            await cell.bus.call(request, to=VICE)
            for request in (SetOutput(name="there", value=True), SetOutput(output=0, value=True))
        ]
        assert [each.success for each in answers] == [False, False]
        assert answers[0].message == "vice has no output there; its outputs are clamp, valve"
        assert answers[1].message == "vice has no output number 0; its outputs are clamp, valve"


async def test_a_pwm_output_of_the_server_is_set_when_its_duty_cycle_is_read_back(tmp_path: Path) -> None:
    pins = SIMULATED + "  lamp: {kind: pwm, pin: 12, safe: 0.0}\n"
    file = written(tmp_path, port=0, pins=pins)
    async with server_of(tmp_path, pins=pins) as server:
        file.write_text(file.read_text(encoding="utf-8").replace("port: 0", f"port: {server.port}"), encoding="utf-8")
        async with opened(file) as cell:
            dim = SetDutyCycle(name="lamp", duty_cycle=0.25)
            assert "not enabled" in (await cell.bus.call(dim, to=VICE)).message
            await cell.enable(WHY)
            assert (await cell.bus.call(dim, to=VICE)).message == "lamp is at 25%"
            latest = cell.bus.topic(f"{VICE}/pwm_outputs", PwmOutputs).latest
            assert latest == PwmOutputs(duty_cycles={"lamp": 0.25})
            await asyncio.to_thread(_lamp_is, server.port, 0.25)


def _lamp_is(port: int, duty_cycle: float) -> None:
    with connected("127.0.0.1", port, name="witness") as client:
        assert client.read().values["lamp"] == duty_cycle


@asynccontextmanager
async def another_client(port: int) -> AsyncGenerator[None]:
    """Control the server from a thread."""
    controls, ends = asyncio.Event(), threading.Event()
    loop = asyncio.get_running_loop()

    def work() -> None:
        with connected("127.0.0.1", port, name="other", control=True) as client:
            loop.call_soon_threadsafe(controls.set)
            while not ends.wait(0.02):
                client.read()

    working = asyncio.ensure_future(asyncio.to_thread(work))
    try:
        await controls.wait()
        yield
    finally:
        ends.set()
        await working


async def test_a_server_that_somebody_else_controls_refuses_and_says_who(tmp_path: Path) -> None:
    async with server_of(tmp_path) as server, opened(written(tmp_path, port=server.port)) as cell:
        async with another_client(server.port):
            with pytest.raises(RobotError, match="clamps is controlled by other"):
                await cell.enable(WHY)
            assert not state_of(cell).enabled
            assert inputs(cell.bus).values == (False,)
        await until(lambda: not cast("EquipmentDevice", cell.equipment[VICE]).controller)
        await cell.enable(WHY)
        assert state_of(cell).enabled


async def test_stop_makes_safe_what_the_document_says_and_sets_nothing_that_waited(tmp_path: Path) -> None:
    """The clamp keeps its value; what was on its way is revoked."""
    async with server_of(tmp_path) as server, opened(written(tmp_path, port=server.port)) as cell:
        await cell.enable(WHY)
        assert (await switched(cell.bus, "clamp", on=False)).success
        waiting = [asyncio.create_task(switched(cell.bus, "valve", on=True)) for _ in range(20)]
        await asyncio.sleep(0)
        await cell.stop()
        await asyncio.wait(waiting)
        await until(lambda: outputs(cell.bus) == {"clamp": False, "valve": False})
        await asyncio.sleep(0.1)
        assert outputs(cell.bus) == {"clamp": False, "valve": False}
        assert not all(each.result().success for each in waiting)


class BusyTransport(EquipmentTransport):
    """Its connection that controls is busy with a request until it is released."""

    def __init__(self, *, port: int) -> None:
        super().__init__(host="127.0.0.1", port=port, client="a test", timeout_s=0.5)
        self.busy, self.released = threading.Event(), threading.Event()

    def write(self, command: EquipmentCommand) -> None:
        """Wait, and send what was not revoked meanwhile."""
        if command.values.get("clamp") is False:
            self.busy.set()
            while not self.released.wait(0.02):
                self.read()  # it is alive: the server does not end its control
        super().write(command)


async def test_a_busy_connection_does_not_delay_stop(tmp_path: Path) -> None:
    """And what it was busy with is not set afterwards."""
    async with server_of(tmp_path) as server:
        transport = BusyTransport(port=server.port)
        about = DeviceReport(device=VICE, driver="equipment", address=transport.address)
        async with SkillBus(new_clock()) as bus, EquipmentDevice(VICE, transport, pins=None, about=about) as device:
            device.register(bus)
            await device.enable(WHY)
            assert (await switched(bus, "valve", on=True)).success
            waiting = asyncio.create_task(switched(bus, "clamp", on=False))
            await asyncio.to_thread(transport.busy.wait, 20.0)
            stopping = asyncio.create_task(device.stop())
            try:
                while (await asyncio.to_thread(values_of, server.port))["valve"]:
                    assert not stopping.done()
            finally:
                transport.released.set()
            await stopping
            assert not (await waiting).success
            assert await asyncio.to_thread(values_of, server.port) == {"clamp": True, "valve": False, "there": False}


def values_of(port: int) -> dict[str, bool | float]:
    """Return what another client reads."""
    with connected("127.0.0.1", port, name="witness") as witness:
        return witness.read().values


async def test_after_a_cut_values_are_read_and_nothing_is_set_until_it_is_enabled_anew(tmp_path: Path) -> None:
    async with server_of(tmp_path) as first:
        port = first.port
        cell_file = written(tmp_path, port=port)
        opening = opened(cell_file)
        cell = await opening.__aenter__()
        await cell.enable(WHY)
        assert (await switched(cell.bus, "valve", on=True)).success
    try:
        await until(lambda: not cell.connection.connected)
        assert "vice at 127.0.0.1" in inputs(cell.bus).problem
        refused = await switched(cell.bus, "valve", on=True)
        assert (refused.success, "vice at 127.0.0.1" in refused.message) == (False, True)
        async with server_of(tmp_path, port=port):
            device = cast("EquipmentDevice", cell.equipment[VICE])
            await until(lambda: state_of(cell).connected)
            await cell.reconnect()
            assert device.lost_reason == ""
            assert outputs(cell.bus) == {"clamp": True, "valve": False}
            assert not (await switched(cell.bus, "valve", on=True)).success
            await cell.enable(WHY)
            assert outputs(cell.bus) == {"clamp": True, "valve": False}
            assert (await switched(cell.bus, "valve", on=True)).success
    finally:
        await opening.__aexit__(None, None, None)


async def test_other_pins_than_those_of_the_document_are_not_controlled(tmp_path: Path) -> None:
    async with (
        server_of(tmp_path, pins=SIMULATED.replace("valve:", "blower:")) as server,
        opened(written(tmp_path, port=server.port)) as cell,
    ):
        with pytest.raises(RobotError, match="other pins than the document of the cell: valve, blower"):
            await cell.enable(WHY)


def hang_until_safe(host: str, port: int) -> float:
    """Block the event loop until another client reads that the valve is off; returns after how many seconds it is."""
    with connected(host, port, name="witness") as witness:
        assert witness.read().values["valve"] is True
        hung_s = time.monotonic()
        while witness.read().values["valve"]:
            assert time.monotonic() - hung_s < 5.0
            time.sleep(0.002)
        return time.monotonic() - hung_s


async def test_an_engine_that_hangs_lets_outputs_go(tmp_path: Path) -> None:
    """Although a thread of it reads on: within 0.3 s, as another client sees."""
    (tmp_path / "served.yaml").write_text(SIMULATED, encoding="utf-8")
    with served_equipment(tmp_path / "served.yaml") as server:
        async with opened(written(tmp_path, host=server.host, port=server.port)) as cell:
            await cell.enable(WHY)
            assert (await switched(cell.bus, "valve", on=True)).success
            took_s = hang_until_safe(server.host, server.port)
            assert took_s < 0.3
            await until(lambda: not state_of(cell).enabled)
            assert "the engine was silent" in state_of(cell).problem
            assert not (await switched(cell.bus, "valve", on=True)).success
            await until(lambda: outputs(cell.bus) == {"clamp": True, "valve": False})


async def test_a_server_that_is_not_there_has_its_remedy_once(tmp_path: Path) -> None:
    host = own_address()
    file = written(tmp_path, host=host, port=1)
    with pytest.raises(RobotError, match=f"equipment does not answer: {host}:1: cannot connect") as refused:
        async with opened(file):
            pass
    assert str(refused.value).count("`flexcell equipment serve`") == 1
