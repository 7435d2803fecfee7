"""Digital signals of the emulated controller as inputs of the arm: read by name, and unknown where nothing is known."""

from __future__ import annotations

import subprocess
from collections.abc import AsyncGenerator, Generator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from engine.cell.drivers import digital_inputs
from engine.cell.open_cell import OpenCell
from engine.document import with_simulated_devices
from engine.document.cell import load_cell
from engine.errors import FlexcellError
from engine.skills.digital_inputs import DigitalInputs
from robots.drivers.abb.abb_connection import AbbConnection
from robots.installed_models import InstalledModels
from robots.port import InputPort
from tests.engine.cli.command import FLEXCELL
from tests.robots.drivers.abb.emulated_irc5 import ARM, EmulatedIrc5, connected, emulated
from tests.robots.drivers.abb.guided_irc5 import guided
from tests.robots.sim.sim_cell import until

SIGNALS = "diDoor,Local/PANEL/diPart"
CELL = """
flexcell: 1
cell: abb
robots:
  arm:
    model: irb4600
    inputs: {{door_closed: 0, part_present: {part}}}
    driver:
      kind: abb_irc5
      host: {host}
      motion_port: {motion_port}
      state_port: {state_port}
      rws: {{port: {rws_port}, inputs: [diDoor, Local/PANEL/diPart], timeout_s: 2.0, stale_s: 4.0}}
      stale_s: 5.0
      timeout_s: 2.0
"""
BEHAVIOR = """
flexcell: 1
name: door
cell: cell.yaml
outcomes: [closed, "off", unknown, timeout]
success: [closed]
root:
  machine:
    initial: part
    states:
      part: {state: io.ReadInput, with: {robot: arm, name: part_present},
             transitions: {"on": door, "off": "off", unknown: unknown}}
      door: {state: io.WaitForInput, with: {robot: arm, name: door_closed, timeout_s: 20.0},
             transitions: {reached: closed, timeout: timeout, unknown: unknown}}
"""


@pytest.fixture(scope="module")
def started() -> Generator[EmulatedIrc5]:
    """The emulator of this file."""
    with emulated(signals=SIGNALS) as controller:
        yield controller


@pytest.fixture
def emulator(started: EmulatedIrc5) -> EmulatedIrc5:
    """The emulator without faults; all signals are off and there."""
    started.do("restore")
    for name in ("diDoor", "diPart"):
        started.do("signal", name=name, on=False, valid=True)
    return started


@asynccontextmanager
async def reading(
    emulator: EmulatedIrc5, *signals: str, stale_s: float = 10.0
) -> AsyncGenerator[tuple[AbbConnection, InputPort]]:
    """The driver with these signals as inputs."""
    rws = {"port": emulator.place["rws_port"], "timeout_s": 5.0, "stale_s": stale_s, "inputs": signals}
    async with connected(emulator, enable=False, rws=rws) as connection:
        inputs = connection.inputs
        assert inputs is not None
        yield connection, inputs


async def test_signals_are_the_inputs_in_the_order_of_the_option(emulator: EmulatedIrc5) -> None:
    async with reading(emulator, "diDoor", "Local/PANEL/diPart") as (connection, inputs):
        assert (inputs.count, inputs.values, inputs.problem) == (2, (False, False), "")
        emulator.do("signal", name="diPart", on=True)
        await until(lambda: inputs.values == (False, True))
        assert (await connection.report(readings=1)).inputs == (False, True)


async def test_a_signal_whose_device_is_gone_is_unknown_by_name(emulator: EmulatedIrc5) -> None:
    async with reading(emulator, "diDoor", "diPart") as (connection, inputs):
        emulator.do("signal", name="diPart", valid=False)
        await until(lambda: bool(inputs.problem))
        assert inputs.problem == (
            "the signal diPart of the controller is not known: its device 'PANEL' tells no valid value"
        )
        assert inputs.values == (await connection.report(readings=1)).inputs == ()
        emulator.do("signal", name="diPart", valid=True)
        await until(lambda: not inputs.problem)


async def test_a_signal_that_the_controller_does_not_have_is_named_and_loses_nothing(emulator: EmulatedIrc5) -> None:
    async with reading(emulator, "diDoor", "diNone") as (connection, inputs):
        assert inputs.problem.startswith("the signal diNone of the controller is not known: HTTP 404 no such resource")
        assert (inputs.values, connection.lost_reason) == ((), "")
        assert connection.facts().safety == "normal"


@pytest.mark.parametrize("fault", ["cut", "freeze", "garbage"])
async def test_inputs_are_unknown_while_web_services_are_lost(emulator: EmulatedIrc5, fault: str) -> None:
    async with reading(emulator, "diDoor", stale_s=1.0) as (_, inputs):
        emulator.do("signal", name="diDoor", on=True)
        await until(lambda: inputs.values == (True,))
        emulator.do("rws_fault", fault=fault)
        await until(lambda: inputs.problem.startswith("RWS "))
        emulator.do("signal", name="diDoor", on=False)
        assert inputs.values == ()
        emulator.do("restore")
        await until(lambda: inputs.values == (False,))


async def test_inputs_are_unknown_while_the_arm_is_lost(emulator: EmulatedIrc5) -> None:
    async with reading(emulator, "diDoor") as (_, inputs):
        emulator.do("close_port", port="state")
        await until(lambda: "state message" in inputs.problem or "link cut" in inputs.problem)
        assert inputs.values == ()


async def test_an_arm_that_is_guided_has_them_too() -> None:
    with emulated(egm=True, comm_timeout_s=5.0, signals=SIGNALS) as emulator:
        emulator.do("signal", name="diDoor", on=True)
        async with guided(emulator, rws=True, inputs=("diDoor",)) as connection:
            inputs = connection.inputs
            assert inputs is not None
            await until(lambda: inputs.values == (True,))
            assert (await connection.report(readings=1)).inputs == (True,)


def written(folder: Path, emulator: EmulatedIrc5, *, part: int = 1) -> Path:
    """Write the cell and return its file."""
    file = folder / "cell.yaml"
    file.write_text(CELL.format(part=part, **emulator.place), encoding="utf-8")
    return file


def test_the_check_knows_how_many_there_are_also_while_the_arm_is_simulated(
    emulator: EmulatedIrc5, tmp_path: Path
) -> None:
    cell = load_cell(written(tmp_path, emulator))
    assert InstalledModels().summary(cell, ARM).digital_inputs == 2
    cell.file.write_text(cell.file.read_text() + "world: {kind: mujoco}\n")
    simulated = with_simulated_devices(load_cell(cell.file), (ARM,))
    assert digital_inputs(simulated, ARM, of_model=0) == 2


@pytest.mark.parametrize(
    ("signals", "outcome"),
    [
        ({"diPart": {"on": True}, "diDoor": {"on": True}}, "closed"),
        ({"diPart": {"on": False}}, "off"),
        ({"diPart": {"on": True}, "diDoor": {"valid": False}}, "unknown"),
    ],
)
def test_a_behavior_reads_signals_by_the_names_of_the_cell(
    emulator: EmulatedIrc5, tmp_path: Path, signals: dict[str, dict[str, bool]], outcome: str
) -> None:
    for name, values in signals.items():
        emulator.do("signal", name=name, **values)
    written(tmp_path, emulator)
    (tmp_path / "door.yaml").write_text(BEHAVIOR, encoding="utf-8")
    command = [FLEXCELL, "run", "door.yaml"]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=120)
    assert f"run finished with {outcome} " in run.stderr, run.stderr


async def test_the_topic_has_the_names_of_the_cell(emulator: EmulatedIrc5, tmp_path: Path) -> None:
    emulator.do("signal", name="diDoor", on=True)
    async with OpenCell(load_cell(written(tmp_path, emulator)), store_path=str(tmp_path / "store.db")) as cell:
        latest = cell.bus.topic(f"{ARM}/digital_inputs", DigitalInputs).latest
        assert latest == DigitalInputs(values=(True, False), names={"door_closed": 0, "part_present": 1})


async def test_a_name_beyond_the_signals_is_refused_with_how_many_there_are(
    emulator: EmulatedIrc5, tmp_path: Path
) -> None:
    with pytest.raises(FlexcellError, match="arm has no input 2 for part_present") as refused:
        async with OpenCell(load_cell(written(tmp_path, emulator, part=2)), store_path=str(tmp_path / "store.db")):
            pass
    assert refused.value.hint == "the controller of arm has the inputs 0 to 1"
