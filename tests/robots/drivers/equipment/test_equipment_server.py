"""The equipment server with pins in memory: who controls, what STOP does, and how configurations are changed."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import TypeVar

import pytest

from engine.errors import RobotError
from robots.drivers.equipment.configuration_file import ConfigurationFile
from robots.drivers.equipment.equipment_server import EquipmentServer
from robots.drivers.equipment.wire.equipment_client import EquipmentClient, connected
from tests.robots.drivers.equipment.served_equipment import SIMULATED

Answer = TypeVar("Answer")
OTHER = SIMULATED.replace("valve:", "blower:")


@asynccontextmanager
async def running(tmp_path: Path) -> AsyncGenerator[tuple[EquipmentServer, ConfigurationFile]]:
    """Serve pins in memory."""
    configuration = ConfigurationFile(tmp_path / "clamps.yaml")
    configuration.file.write_text(SIMULATED, encoding="utf-8")
    async with EquipmentServer(configuration, host="127.0.0.1", port=0) as server:
        yield server, configuration


async def asked(
    server: EquipmentServer, ask: Callable[[EquipmentClient], Answer], *, name: str = "test", control: bool = False
) -> Answer:
    """Connect in a thread, as the client blocks, and return what it was answered."""

    def work() -> Answer:
        with connected("127.0.0.1", server.port, name=name, control=control) as client:
            return ask(client)

    return await asyncio.to_thread(work)


async def test_a_second_client_may_read_and_not_control(tmp_path: Path) -> None:
    """It is told the name and address of the first."""

    def ask(first: EquipmentClient) -> str:
        first.set({"valve": True})
        with connected("127.0.0.1", port, name="reader") as reader:
            seen = reader.read()
            with pytest.raises(RobotError, match="does not control"):
                reader.set({"valve": False})
        with (
            pytest.raises(RobotError, match=r"clamps is controlled by first at 127\.0\.0\.1:\d+"),
            connected("127.0.0.1", port, name="second", control=True),
        ):
            pass
        assert first.read().values["valve"] is True
        assert seen.values["valve"] is True
        return seen.controller

    async with running(tmp_path) as (server, _):
        port = server.port
        assert (await asked(server, ask, name="first", control=True)).startswith("first at 127.0.0.1:")


async def test_outputs_are_safe_after_the_client_and_the_next_may_control(tmp_path: Path) -> None:
    """What was set does not return."""
    async with running(tmp_path) as (server, _):
        await asked(server, lambda client: client.set({"valve": True, "clamp": False}), control=True)
        seen = await asked(server, lambda client: client.read(), control=True)
        while seen.values["valve"]:  # the thread of the pins sets them before its next reading
            seen = await asked(server, lambda client: client.read())
        assert seen.values == {"clamp": True, "valve": False, "there": False}


async def test_stop_leaves_what_holds_and_makes_the_others_safe(tmp_path: Path) -> None:
    """From a client that does not control."""

    def ask(client: EquipmentClient) -> dict[str, bool | float]:
        client.set({"valve": True, "clamp": False})
        with connected("127.0.0.1", port, name="stop") as stopping:
            stopping.stop()
        return client.read().values

    async with running(tmp_path) as (server, _):
        port = server.port
        assert await asked(server, ask, control=True) == {"clamp": False, "valve": False, "there": False}


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"valv": True}, "clamps has no pin `valv`.*valve"),
        ({"there": True}, "`there` is an input"),
        ({"valve": 0.5}, "`valve` is on or off and not 0.5"),
    ],
)
async def test_wrong_values_are_refused_whole(tmp_path: Path, values: dict[str, bool | float], words: str) -> None:
    """Nothing of the request is set."""

    def ask(client: EquipmentClient) -> dict[str, bool | float]:
        with pytest.raises(RobotError, match=words):
            client.set({"clamp": False, **values})
        return client.read().values

    async with running(tmp_path) as (server, _):
        assert (await asked(server, ask, control=True))["clamp"] is True


async def test_two_managers_lose_nothing(tmp_path: Path) -> None:
    """The second has an outdated base, and is refused; the text of the first stays, the one before is kept."""
    async with running(tmp_path) as (server, configuration):
        base = (await asked(server, lambda client: client.configuration())).digest
        await asked(server, lambda client: client.configure(OTHER, base=base))
        with pytest.raises(RobotError, match="was changed since you have read it"):
            await asked(server, lambda client: client.configure(SIMULATED, base=base))
        read = await asked(server, lambda client: client.configuration())
        assert (read.text, len(read.kept)) == (OTHER, 1)
        assert "blower" in (await asked(server, lambda client: client.read())).values
        await asked(server, lambda client: client.roll_back(base=read.digest))
        again = await asked(server, lambda client: client.configuration())
        assert (again.text, again.kept, configuration.text()) == (SIMULATED, (), SIMULATED)


async def test_an_invalid_configuration_changes_nothing(tmp_path: Path) -> None:
    """It is refused with file, line and column."""
    async with running(tmp_path) as (server, configuration):
        base = (await asked(server, lambda client: client.configuration())).digest
        with pytest.raises(RobotError, match=r"clamps\.yaml:\d+:\d+: "):
            await asked(server, lambda client: client.configure(SIMULATED.replace("safe: true, ", ""), base=base))
        assert (configuration.text(), configuration.kept()) == (SIMULATED, ())


async def test_a_configuration_whose_pins_are_not_reached_is_taken_back(tmp_path: Path) -> None:
    """The one before is served again, and the file has it."""
    unreached = SIMULATED.replace("{kind: simulated}", "{kind: modbus_tcp, host: 127.0.0.1, port: 1}")
    async with running(tmp_path) as (server, configuration):
        base = (await asked(server, lambda client: client.configuration())).digest
        with pytest.raises(RobotError, match="was taken back"):
            await asked(server, lambda client: client.configure(unreached, base=base))
        assert configuration.text() == SIMULATED
        assert (await asked(server, lambda client: client.read())).problem == ""


async def test_nobody_changes_the_configuration_under_a_client_that_controls(tmp_path: Path) -> None:
    """It says who that is."""

    def ask(client: EquipmentClient) -> None:
        with connected("127.0.0.1", port, name="other") as other, pytest.raises(RobotError, match="controlled by test"):
            other.restart()
        client.read()

    async with running(tmp_path) as (server, _):
        port = server.port
        await asked(server, ask, control=True)
