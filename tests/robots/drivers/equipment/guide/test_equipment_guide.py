"""The terminal guide at a real server: pins as they are, a pin added, set and taken back; what is refused is said."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path
from typing import cast

import pytest
from textual.pilot import Pilot
from textual.widgets import Button, DataTable, Input, Label, TextArea

from engine.errors import RobotError
from robots.drivers.equipment.guide import EquipmentGuide, guide_equipment
from robots.drivers.equipment.guide.pin_form import with_pin
from robots.drivers.equipment.wire.equipment_client import connected_to_configure
from tests.robots.drivers.equipment.served_equipment import SIMULATED, ServedEquipment, doomed_client, served_equipment
from tests.robots.own_address import own_address

SIZE = (140, 45)


def guide(server: ServedEquipment) -> EquipmentGuide:
    """Return the page of a server."""
    return EquipmentGuide(
        lambda: connected_to_configure(server.host, server.port, name="a test", timeout_s=10.0),
        address=f"{server.host}:{server.port}",
    )


def label_of(app: EquipmentGuide, label: str = "result") -> str:
    """Return what a label says."""
    return "".join(str(each.content) for each in app.screen_stack[0].query(f"#{label}").results(Label))


def document(app: EquipmentGuide) -> str:
    """Return the text that is edited; empty before the page is there."""
    return "".join(each.text for each in app.screen_stack[0].query("#document").results(TextArea))


def pins(app: EquipmentGuide) -> dict[str, str]:
    """Return the values of the pins as they are shown."""
    tables = [cast("DataTable[str]", each) for each in app.screen_stack[0].query("#pins")]
    rows = (table.get_row_at(row) for table in tables for row in range(table.row_count))
    return {str(name): str(value) for name, _, value in rows}


async def until(pilot: Pilot[None], condition: Callable[[], bool]) -> None:
    """Wait for what threads of the page bring about."""
    async with asyncio.timeout(60.0):
        # What the page shows tells nobody that it has changed: it can only be looked at.
        while not condition():
            await pilot.pause(0.02)


async def press(pilot: Pilot[None], app: EquipmentGuide, button: str) -> None:
    """Press a button of the page or of the form on it, once it is there."""
    await until(pilot, lambda: bool(app.screen.query(f"#{button}")))
    app.screen.query_one(f"#{button}", Button).press()


async def test_a_pin_is_added_set_and_taken_back(tmp_path: Path) -> None:
    file = tmp_path / "clamps.yaml"
    file.write_text(SIMULATED, encoding="utf-8")
    with served_equipment(file) as server:
        app = guide(server)
        async with app.run_test(size=SIZE) as pilot:
            await until(pilot, lambda: pins(app) == {"clamp": "on", "valve": "off", "there": "off"})
            await until(pilot, lambda: document(app) == SIMULATED)
            await until(pilot, lambda: label_of(app).startswith("in effect, digest "))
            await press(pilot, app, "add_pin")
            await until(pilot, lambda: bool(app.screen.query("#name")))
            app.screen.query_one("#name", Input).value = "light"
            await press(pilot, app, "add")
            problem = app.screen.query_one("#problem", Label)
            await until(pilot, lambda: str(problem.content) == "give a name and a number")
            app.screen.query_one("#pin", Input).value = "5"
            await press(pilot, app, "add")
            await until(pilot, lambda: "  light: {kind: digital_output, pin: 5, safe: false}\n" in document(app))
            await until(pilot, lambda: label_of(app, "valid") == "valid")
            assert file.read_text(encoding="utf-8") == SIMULATED
            await press(pilot, app, "set")
            await until(pilot, lambda: pins(app).get("light") == "off")
            assert "light" in file.read_text(encoding="utf-8")
            await press(pilot, app, "roll_back")
            await until(pilot, lambda: "light" not in pins(app))
            await until(pilot, lambda: "light" not in document(app))
            assert file.read_text(encoding="utf-8") == SIMULATED


async def test_what_is_not_valid_is_not_sent_and_its_place_is_shown(tmp_path: Path) -> None:
    file = tmp_path / "clamps.yaml"
    file.write_text(SIMULATED, encoding="utf-8")
    with served_equipment(file) as server:
        app = guide(server)
        async with app.run_test(size=SIZE) as pilot:
            await until(pilot, lambda: document(app) == SIMULATED)
            app.query_one("#document", TextArea).load_text(SIMULATED.replace("safe: true", "safe: maybe"))
            await until(pilot, lambda: label_of(app, "valid").startswith("not valid: configuration:6:"))
            await pilot.press("ctrl+s")
            await until(pilot, lambda: label_of(app).startswith("not set: configuration:6:"))
            assert file.read_text(encoding="utf-8") == SIMULATED


async def test_a_change_of_somebody_else_and_a_client_that_controls_refuse_it(tmp_path: Path) -> None:
    """What was edited is still there."""
    file = tmp_path / "clamps.yaml"
    file.write_text(SIMULATED, encoding="utf-8")
    edited = with_pin(SIMULATED, "  light: {kind: digital_output, pin: 5, safe: false}\n")
    with served_equipment(file) as server:
        app = guide(server)
        async with app.run_test(size=SIZE) as pilot:
            await until(pilot, lambda: document(app) == SIMULATED)
            with connected_to_configure(server.host, server.port, name="another", timeout_s=10.0) as other:
                base = other.configuration().digest
                other.configure(SIMULATED + "  horn: {kind: digital_output, pin: 9, safe: false}\n", base=base)
            app.query_one("#document", TextArea).load_text(edited)
            await pilot.press("ctrl+s")
            await until(pilot, lambda: label_of(app).startswith("did not set: "))
            assert document(app) == edited
            await pilot.press("ctrl+r")
            await until(pilot, lambda: "horn" in document(app))
        with doomed_client(server):
            app = guide(server)
            async with app.run_test(size=SIZE) as pilot:
                await until(pilot, lambda: "horn" in document(app))
                app.query_one("#document", TextArea).load_text(edited)
                await pilot.press("ctrl+s")
                await until(pilot, lambda: label_of(app).startswith("did not set: "))
                assert "doomed" in label_of(app)


async def test_a_server_that_ends_is_shown_and_the_text_is_kept(tmp_path: Path) -> None:
    file = tmp_path / "clamps.yaml"
    file.write_text(SIMULATED, encoding="utf-8")
    with served_equipment(file) as server:
        app = guide(server)
        async with app.run_test(size=SIZE) as pilot:
            await until(pilot, lambda: document(app) == SIMULATED)
            server.process.kill()
            await until(pilot, lambda: "cannot connect" in app.sub_title)
            assert pins(app) == {}
            assert document(app) == SIMULATED


def test_without_a_server_there_is_no_page() -> None:
    with pytest.raises(RobotError, match="cannot connect"):
        guide_equipment(own_address(), 1, name="a test", timeout_s=1.0)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("pins:\n  a: {pin: 1}\n", "pins:\n  a: {pin: 1}\n  b: x\n"),
        ("pins:\n  a:\n    pin: 1\n\nsilence_s: 0.1\n", "pins:\n  a:\n    pin: 1\n  b: x\n\nsilence_s: 0.1\n"),
        ("pins:\n  a: {pin: 1}", "pins:\n  a: {pin: 1}\n  b: x\n"),
        ("equipment: e\n", "equipment: e\npins:\n  b: x\n"),
    ],
)
def test_a_pin_comes_after_the_others(text: str, expected: str) -> None:
    assert with_pin(text, "  b: x\n") == expected
