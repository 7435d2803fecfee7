"""The contract of drivers: capabilities name skills, and the schema of cells has the options of installed drivers."""

from __future__ import annotations

import json
import pkgutil
from collections.abc import Iterator
from importlib import import_module
from typing import Any

import jsonschema
import pytest

import engine.skills
from engine.bus import SkillBus
from engine.cell.drivers import Emulator, EmulatorOptions, cell_schema_text, installed_drivers
from engine.cell.drivers.capabilities import CAPABILITIES, SKILL_CAPABILITIES
from engine.clock import new_clock
from engine.errors import FlexcellError, NoSuchSkill
from engine.registry import load_states
from engine.skill import Skill
from engine.skills.hand import ReadHand
from engine.state import State

CELL: dict[str, object] = {"flexcell": 1, "cell": "bench", "world": {"kind": "mujoco"}}


def subclasses(kind: type) -> Iterator[type]:
    for each in kind.__subclasses__():
        yield each
        yield from subclasses(each)


def cell_with(driver: object) -> dict[str, object]:
    gripper = {"model": "robotiq_2f85", "driver": driver}
    return CELL | {"robots": {"left": {"model": "ur10", "gripper": gripper}}}


def is_valid(document: object) -> bool:
    validator: Any = jsonschema.Draft202012Validator(json.loads(cell_schema_text()))
    return validator.is_valid(document)


def test_every_skill_with_a_capability_exists() -> None:
    for module in pkgutil.iter_modules(engine.skills.__path__):
        import_module(f"engine.skills.{module.name}")
    names = {skill.skill_name() for skill in subclasses(Skill) if issubclass(skill, Skill)}
    assert set(SKILL_CAPABILITIES) - names == set()
    assert set(SKILL_CAPABILITIES.values()) == set(CAPABILITIES)


def test_every_capability_of_a_state_exists() -> None:
    load_states()
    needed = {state.capability for state in subclasses(State) if issubclass(state, State)}
    assert needed - {""} <= set(CAPABILITIES)
    assert len(needed) > 5


def test_every_installed_driver_says_what_was_proven_and_where_its_page_is() -> None:
    drivers = installed_drivers()
    assert "robotiq" in drivers
    for kind, driver in drivers.items():
        assert driver.kind == kind == driver.options.__struct_config__.tag
        assert len(driver.proven) > 20
        assert driver.page.startswith("docs/how-to/")
        assert driver.capabilities <= set(CAPABILITIES)


@pytest.mark.parametrize(
    ("driver", "valid"),
    [
        ("sim", True),
        ({"kind": "robotiq", "connection": {"kind": "urcap", "host": "192.168.1.5"}}, True),
        ({"kind": "robotiq", "connection": {"kind": "urcap", "hots": "192.168.1.5"}}, False),
        ({"kind": "robotiq"}, False),
        ({"kind": "of_another_package", "anything": 1}, True),
        ({"host": "192.168.1.5"}, False),
    ],
)
def test_the_schema_of_a_cell_has_the_options_of_the_installed_drivers(driver: object, valid: bool) -> None:
    assert is_valid(cell_with(driver)) is valid


@pytest.mark.virtual
async def test_a_skill_that_is_not_served_is_refused_with_the_reason_of_its_driver() -> None:
    driver = installed_drivers()["robotiq"]
    async with SkillBus(new_clock()) as bus:
        bus.explain_missing("left/gripper", driver.lacks_for_skill)
        with pytest.raises(NoSuchSkill, match="the driver robotiq has no hand commands, only gripper commands"):
            await bus.call(ReadHand(), to="left/gripper")
        with pytest.raises(NoSuchSkill, match="no such service"):
            await bus.call(ReadHand(), to="right/gripper")


class KettleOptions(EmulatorOptions, frozen=True, kw_only=True):
    """Of a device that nobody has."""

    litres: float = 1.0


def test_options_of_an_emulator_are_read_from_texts() -> None:
    kettle = Emulator(kind="kettle", summary="", options=KettleOptions, serve="nowhere:nothing")
    assert kettle.read_options({"litres": "1.5"}) == KettleOptions(litres=1.5)
    with pytest.raises(FlexcellError, match=r"kettle has no option `liters`.*did you mean litres"):
        kettle.read_options({"liters": "1"})
    with pytest.raises(FlexcellError, match=r"the emulator kettle: .*litres"):
        kettle.read_options({"litres": "much"})
