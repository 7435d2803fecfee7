"""The scene that a cell document gives: sizes, colours, jitter, refusals."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from engine.document.cell import CellDocument, GripperEntry, load_cell
from engine.errors import CellError
from robots.sim.cell_model import build_cell
from robots.sim.cell_scene import scene_of

CELL = Path(__file__).parents[3] / "behaviors" / "cells" / "dual_panda.yaml"


@pytest.fixture(name="document")
def _document() -> CellDocument:
    return load_cell(CELL).document


def test_the_shipped_cell_compiles_with_both_arms_and_its_parts(document: CellDocument) -> None:
    cell = build_cell(scene_of(document))
    assert [arm.name for arm in cell.arms] == ["left", "right"]
    assert cell.parts == tuple(document.parts)


def test_a_seed_moves_parts_and_adding_a_part_moves_no_other(document: CellDocument) -> None:
    name = next(iter(document.parts))
    alone = msgspec.structs.replace(document, parts={name: document.parts[name]})
    (part,) = scene_of(alone, seed=3).parts
    assert part == scene_of(document, seed=3).parts[0]
    assert part.pose != scene_of(document).parts[0].pose


def test_a_part_taken_from_the_document_is_gone_from_the_world(document: CellDocument) -> None:
    assert build_cell(scene_of(msgspec.structs.replace(document, parts={}))).parts == ()


def test_a_gripper_that_the_robot_does_not_come_with_is_refused_by_name(document: CellDocument) -> None:
    robots = {"left": msgspec.structs.replace(document.robots["left"], gripper=GripperEntry(model="claw"))}
    with pytest.raises(CellError, match="comes with the gripper panda_hand, not claw"):
        scene_of(msgspec.structs.replace(document, robots=robots))
