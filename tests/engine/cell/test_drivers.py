"""The contract of drivers: capabilities name skills, and the schema of cells has the options of installed drivers."""

from __future__ import annotations

import ast
import json
import pkgutil
from collections.abc import Iterator
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any

import jsonschema
import pytest

import engine.skills
from engine.bus import SkillBus
from engine.cell.drivers import Emulator, EmulatorOptions, cell_schema_text, installed_drivers
from engine.clock import new_clock
from engine.errors import FlexcellError, NoSuchSkill
from engine.messages import HandState
from engine.registry import load_states
from engine.skill import CAPABILITIES, Skill, required_capability
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


def all_skills() -> set[type[Skill[Any]]]:
    for module in pkgutil.iter_modules(engine.skills.__path__):
        import_module(f"engine.skills.{module.name}")
    return {skill for skill in subclasses(Skill) if issubclass(skill, Skill)}


def test_every_capability_is_needed_by_a_skill_and_found_by_its_name() -> None:
    needed = {skill.capability for skill in all_skills()} - {None}
    assert needed == set(CAPABILITIES)
    for skill in all_skills():
        assert required_capability(skill.skill_name()) == skill.capability
    assert required_capability("no_such_skill") is None


def test_every_state_names_the_skills_with_a_capability_that_its_module_constructs() -> None:
    load_states()
    skilled = {skill.__name__: skill for skill in all_skills() if skill.capability is not None}
    states: dict[str, set[type[Skill[Any]]]] = {}
    for state in subclasses(State):
        if issubclass(state, State) and state.__module__.startswith("states."):
            states.setdefault(state.__module__, set()).update(state.skills)
    for module, named in states.items():
        constructed = {skilled[name] for name in _called(module) if name in skilled}
        assert constructed <= named, f"{module} constructs a skill that `skills` of its state does not name"
    assert sum(map(bool, states.values())) > 20


def _called(module: str) -> Iterator[str]:
    """Yield the names that a module calls, without their prefixes; not those of its own states."""
    tree = ast.parse(Path(import_module(module).__file__ or "").read_text("utf-8"))
    own = {node.name for node in tree.body if isinstance(node, ast.ClassDef)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id not in own:
            yield node.func.id
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            yield node.func.attr


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


@pytest.mark.virtual
async def test_a_skill_that_its_driver_lacks_is_left_out_where_it_is_advertised() -> None:
    driver = installed_drivers()["robotiq"]

    async def read_hand(_request: ReadHand) -> HandState:
        raise AssertionError

    async with SkillBus(new_clock()) as bus:
        bus.explain_missing("left/gripper", driver.lacks_for_skill)
        for namespace in ("left/gripper", "right/hand"):
            bus.advertise_service(ReadHand, read_hand, namespace=namespace)
        assert tuple(bus.skills()) == ("right/hand/read_hand",)
        with pytest.raises(NoSuchSkill, match="the driver robotiq has no hand commands"):
            await bus.call(ReadHand(), to="left/gripper")


def test_a_driver_names_skills_that_it_cannot_do_in_spite_of_its_capabilities() -> None:
    driver = replace(installed_drivers()["robotiq"], missing_skills={"gripper_move": "it only opens and closes"})
    assert driver.lacks_for_skill("gripper_move") == "it only opens and closes"
    assert driver.lacks_for_skill("gripper_open") == ""


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
