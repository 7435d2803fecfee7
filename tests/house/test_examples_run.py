"""Every YAML example of the guides is what it is shown for: behaviors have no mistake, other documents are taken."""

from __future__ import annotations

import re
import shutil
from pathlib import Path
from textwrap import indent

import pytest

from engine.check import check_behavior
from engine.document import parse_behavior
from engine.document.cell import load_cell
from engine.document.entries_document import load_entries
from engine.document.equipment import read_equipment
from engine.document.faults import parse_faults
from engine.document.module_document import load_module
from engine.document.substitutes import parse_substitutes
from engine.document.sweep import parse_sweep
from engine.registry import load_states
from engine.runtime.control import load_breakpoints
from engine.runtime.control.breakpoint import breakpoints_file
from engine.sweep import SweepSubject, configurations
from engine.sweep.search.search_plan import SearchPlan
from engine.teaching import load_triggers
from robots.scene.scene_builder import build_scene
from tests.house.shown_examples import BEHAVIOR, SHOWN, shown

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "docs" / "how-to" / "examples"
BEHAVIORS = ROOT / "behaviors"
ROBOT, FAULTS, BREAKPOINTS = "\nrobot:", "\nfaults:", "\nbreakpoints:"
SUBSTITUTES = "\nsubstitutes:"
TRIGGERS = "\ntriggers:"
NOTES = "canvas_notes:"
TAGS = "\ntags:"
FACTORS = "\nfactors:"
MODULE, EQUIPMENT = "\nmodule:", "\nequipment:"
PARTS_OF_CELLS = (
    "robots:",
    "parts:",
    "fixtures:",
    "world:",
    "people:",
    "cameras:",
    "topics:",
    "bus:",
    "unknown_bodies:",
    "equipment:",
)
STORES = ("store:",)
PARTS_OF_TREES = ("condition:", "behaviour:", "sequence:", "while_do_else:")


@shown(holding=BEHAVIOR)
def test_a_behavior_has_no_mistake(text: str) -> None:
    """It runs to its success in `tests/behaviors/test_shown_behaviors.py`."""
    text = text.replace("../cells", str(BEHAVIORS / "cells"))
    behavior = parse_behavior(text, file=BEHAVIORS / "reconcycle" / "shown.yaml")
    assert [str(each) for each in check_behavior(behavior, load_states()) if each.severity == "error"] == []


@shown(*PARTS_OF_CELLS)
def test_a_part_of_a_cell_makes_a_world(tmp_path: Path, text: str) -> None:
    """With the robots, fixtures and parts that it names."""
    shutil.copytree(EXAMPLES, tmp_path, dirs_exist_ok=True)
    file = tmp_path / "cell.yaml"
    rest = "" if text.startswith("world:") else "world: {kind: mujoco}\n"
    file.write_text(f"flexcell: 1\ncell: shown\n{rest}{text}", encoding="utf-8")
    cell = load_cell(file)
    scene = build_scene(cell.document, seed=None, resolve=cell.resolve)
    assert {arm.name for arm in scene.arms} == set(cell.document.robots)
    assert {part.name for part in scene.parts} == set(cell.document.parts)
    assert scene.frames.keys() == cell.document.frames.keys()
    assert {person.name for person in scene.people} == set(cell.document.people)
    assert {body.name for body in (*scene.unknown_fixtures, *scene.unknown_parts)} == set(cell.document.unknown_bodies)


@shown(*STORES)
def test_a_store_of_a_cell_is_taken(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    monkeypatch.setenv("CELL_PASSWORD", "secret")
    file = tmp_path / "cell.yaml"
    file.write_text(f"flexcell: 1\ncell: shown\n{text}", encoding="utf-8")
    assert load_cell(file).document.store is not None


@shown(holding=ROBOT)
def test_a_robot_is_the_one_in_the_examples(text: str) -> None:
    """Which a test simulates; comments aside."""
    whole = (EXAMPLES / "lifter" / "robot.yaml").read_text(encoding="utf-8")
    assert re.sub(r" +#.*", "", text) == re.sub(r" +#.*", "", whole)


@shown(holding=MODULE)
def test_a_module_is_the_one_in_the_examples(text: str) -> None:
    """Which the cells of the examples dock."""
    file = EXAMPLES / text.partition("\n")[0].removeprefix("# ")
    assert text.partition("\n")[2] == file.read_text(encoding="utf-8")
    load_module(file)


@shown(holding=EQUIPMENT)
def test_equipment_has_no_mistake(text: str) -> None:
    assert read_equipment(text, file=Path("clamps.yaml")).document.pins


@shown(*PARTS_OF_TREES)
def test_a_part_of_a_tree_is_sound(text: str) -> None:
    head = "flexcell: 1\nname: shown\noutcomes: [success, failure]\nsuccess: [success]\nroot:\n  tree:\n"
    behavior = parse_behavior(head + indent(text, "    "), file=ROOT / "behaviors" / "shown.yaml")
    assert [str(each) for each in check_behavior(behavior, load_states()) if each.severity == "error"] == []


@shown(holding=SUBSTITUTES)
def test_substitutes_are_taken(text: str) -> None:
    assert parse_substitutes(text, file="example.yaml").document.substitutes


@shown(holding=FAULTS)
def test_faults_are_taken(text: str) -> None:
    assert len(parse_faults(text, file="faults.yaml").document.faults) == text.count("\n  - ")


@shown(holding=BREAKPOINTS)
def test_breakpoints_are_taken(tmp_path: Path, text: str) -> None:
    behavior = tmp_path / "shown.yaml"
    breakpoints_file(behavior).write_text(text, encoding="utf-8")
    assert len(load_breakpoints(behavior)) == text.count("path:")


@shown(holding=TRIGGERS)
def test_triggers_are_taken(tmp_path: Path, text: str) -> None:
    file = tmp_path / "triggers.yaml"
    file.write_text(text, encoding="utf-8")
    assert len(load_triggers(file)) == text.count("trig_name:")


@shown(holding=TAGS)
def test_entries_are_taken_with_their_tags(tmp_path: Path, text: str) -> None:
    file = tmp_path / "entries.yaml"
    file.write_text(text, encoding="utf-8")
    assert any(record.tags for record in load_entries(file).records())


@shown(holding=FACTORS)
def test_sweeps_are_taken_and_vary_what_there_is(tmp_path: Path, text: str) -> None:
    """The behavior and its cell are those of the repository; a document of faults is written beside."""
    (tmp_path / "slip.yaml").write_text("flexcell: 1\nfaults: [{error: it slips}]\n", encoding="utf-8")
    sweep = parse_sweep(text.replace("../reconcycle", str(BEHAVIORS / "reconcycle")), file=tmp_path / "s.yaml")
    assert len(configurations(sweep)) == sweep.document.runs
    assert set(SweepSubject.load(sweep).nominal) == set(sweep.document.factors)


@shown("search:")
def test_searches_are_taken_and_know_their_number(tmp_path: Path, text: str) -> None:
    """Of the factors that stand before it on the page."""
    factors = "factors: {parameters.speed: {uniform: [0.3, 1.0]}}\n"
    behavior = BEHAVIORS / "reconcycle" / "two_arm_transfer.yaml"
    sweep = parse_sweep(f"flexcell: 1\nbehavior: {behavior}\n{factors}{text}", file=tmp_path / "s.yaml")
    assert sweep.document.search is not None
    batch = SearchPlan(SweepSubject.load(sweep).sweep).due()
    assert len(batch) == sweep.document.search.batch


@shown("require:")
def test_requirements_are_taken(tmp_path: Path, text: str) -> None:
    factors = "factors: {parameters.speed: {uniform: [0.3, 1.0]}}\n"
    behavior = BEHAVIORS / "reconcycle" / "two_arm_transfer.yaml"
    sweep = parse_sweep(f"flexcell: 1\nbehavior: {behavior}\n{factors}{text}", file=tmp_path / "s.yaml")
    assert len(sweep.document.requirements) == text.count("\n  - ")


@shown(NOTES)
def test_free_notes_are_taken_beside_a_behavior(tmp_path: Path, text: str) -> None:
    """Their container is that of the page: a machine called `transfer`."""
    inside = "machine: {initial: a, states: {a: {state: bench.Wait, transitions: {done: finished}}}}"
    root = f"root: {{machine: {{initial: transfer, states: {{transfer: {{{inside}}}}}}}}}"
    behavior = parse_behavior(
        f"flexcell: 1\nname: noted\noutcomes: [finished]\n{root}\n{text}", file=tmp_path / "n.yaml"
    )
    assert sum(len(notes) for notes in behavior.document.canvas_notes.values()) == text.count("text:")


def test_every_example_is_of_a_kind_that_is_tried() -> None:
    """A new kind of example comes with its test."""
    kinds = (BEHAVIOR, ROBOT, FAULTS, SUBSTITUTES, BREAKPOINTS, TRIGGERS, TAGS, FACTORS, MODULE, EQUIPMENT)
    begun = (NOTES, *PARTS_OF_CELLS, *STORES, *PARTS_OF_TREES, "search:", "require:")
    unknown = [n for n, text in SHOWN.items() if not text.startswith(begun) and not any(kind in text for kind in kinds)]
    assert unknown == []
