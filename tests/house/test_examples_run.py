"""Every YAML example of the guides does what it is shown for: behaviors run, other documents are taken."""

from __future__ import annotations

import re
import shutil
from pathlib import Path
from textwrap import indent

import msgspec
import numpy as np
import pytest

from engine.cause_chain import describe_cause
from engine.cell.open_cell import OpenCell
from engine.check import check_behavior
from engine.clock import run_virtual
from engine.document import parse_behavior
from engine.document.cell import load_cell
from engine.document.entries_document import load_entries
from engine.document.faults import parse_faults
from engine.document.module_document import load_module
from engine.document.substitutes import parse_substitutes
from engine.document.sweep import parse_sweep
from engine.messages.demonstrations import Trajectory
from engine.registry import load_states
from engine.runtime.control import load_breakpoints
from engine.runtime.control.breakpoint import breakpoints_file
from engine.skills.entries import WriteEntry
from engine.sweep import SweepSubject, configurations
from engine.sweep.search.search_plan import SearchPlan
from engine.teaching import load_triggers
from engine.testing.behavior_run import run_behavior
from robots.scene.scene_builder import build_scene

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "docs" / "how-to" / "examples"
PAGES = [ROOT / "README.md", *(ROOT / "docs/concepts").glob("*.md"), *(ROOT / "docs/how-to").glob("*.md")]
BEHAVIORS = ROOT / "behaviors"
CELL = BEHAVIORS / "cells" / "dual_panda.yaml"
BEHAVIOR, ROBOT, FAULTS, BREAKPOINTS = "\nroot:", "\nrobot:", "\nfaults:", "\nbreakpoints:"
SUBSTITUTES = "\nsubstitutes:"
TRIGGERS = "\ntriggers:"
NOTES = "canvas_notes:"
TAGS = "\ntags:"
FACTORS = "\nfactors:"
MODULE = "\nmodule:"
PARTS_OF_CELLS = ("robots:", "parts:", "fixtures:", "world:", "people:", "cameras:", "topics:", "unknown_bodies:")
STORES = ("store:",)
PARTS_OF_TREES = ("condition:", "behaviour:", "sequence:", "while_do_else:")
SHOWN = {
    f"{page.relative_to(ROOT)}-{number}": text
    for page in sorted(PAGES)
    for number, text in enumerate(re.findall(r"(?ms)^```yaml\n(.*?)^```", page.read_text(encoding="utf-8")), 1)
}


def shown(*beginnings: str, holding: str = "") -> pytest.MarkDecorator:
    """The examples that begin so, or hold this."""
    chosen = [
        pytest.param(text, id=name)
        for name, text in SHOWN.items()
        if (beginnings and text.startswith(beginnings)) or (holding and holding in text)
    ]
    return pytest.mark.parametrize("text", chosen)


@shown(holding=BEHAVIOR)
def test_a_behavior_runs_to_its_success(tmp_path: Path, text: str) -> None:
    """In the cell it names, else that of the two Pandas; what it was shown by hand is in the store."""
    file, store = tmp_path / "example.yaml", tmp_path / "store.db"
    file.write_text(text.replace("../cells", str(CELL.parent)), encoding="utf-8")
    cell = None if "\ncell:" in text else CELL
    if "recording: led" in text:
        run_virtual(lead_by_hand(store))
    ran = run_behavior(file, catalogue=load_states(), store=store, cell=cell)
    success = parse_behavior(text, file=file).success
    assert ran.outcome in success, describe_cause(ran.result.cause) if ran.result.cause else ran.result


async def lead_by_hand(store: Path) -> None:
    """Keep the recording of a hand that turns the left arm by a quarter of a radian in two seconds."""
    times = np.linspace(0.0, 2.0, 101)
    joints = np.tile((0.0, -0.785398163, 0.0, -2.35619449, 0.0, 1.570796327, 0.785398163), (101, 1))
    joints[:, 0] = 0.25 * np.sin(np.pi * np.clip(times - 0.2, 0.0, 1.6) / 3.2) ** 2
    led = Trajectory(times_s=tuple(times.tolist()), joints=tuple(tuple(row) for row in joints.tolist()))
    async with OpenCell(load_cell(CELL), store_path=str(store)) as cell:
        await cell.bus.call(WriteEntry(kind="trajectory", name="led", value=msgspec.to_builtins(led)), to="store")


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
    kinds = (BEHAVIOR, ROBOT, FAULTS, SUBSTITUTES, BREAKPOINTS, TRIGGERS, TAGS, FACTORS, MODULE)
    begun = (NOTES, *PARTS_OF_CELLS, *STORES, *PARTS_OF_TREES, "search:", "require:")
    unknown = [n for n, text in SHOWN.items() if not text.startswith(begun) and not any(kind in text for kind in kinds)]
    assert unknown == []
