"""The names that a cell offers before it is opened are those that its world has."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from engine.cell.cell_names import cell_names
from engine.document.cell import load_cell
from robots.installed_models import MODELS
from robots.scene.scene_builder import build_scene
from robots.sim.physics.cell_model import build_cell

CELLS = sorted((Path(__file__).parents[2] / "behaviors" / "cells").glob("*.yaml"))


@pytest.mark.parametrize("file", CELLS, ids=lambda file: file.stem)
def test_the_frames_of_a_cell_are_those_that_its_world_shows(file: Path) -> None:
    """And `world`, which is no body: those of bodies, and those that have a name only."""
    cell = load_cell(file)
    scene = build_scene(cell.document, resolve=cell.resolve)
    shown = {*build_cell(scene).frames, *scene.frames}
    names = cell_names(cell)
    assert [name for name in shown if not names.has("frame", name)] == []
    assert names.by_kind["frame"] - shown == {"world"}


def test_tools_and_planners_come_from_the_models() -> None:
    """The IRB 4600 carries a magnet."""
    names = cell_names(load_cell(next(file for file in CELLS if file.stem == "irb4600"))).by_kind
    assert (names["tool"], names["magnet"], names["gripper"]) == ({"arm/magnet"}, {"arm"}, frozenset())
    assert {"fast", "stomp", "RRTConnect"} <= names["planner"]


def test_a_mesh_is_reported_where_what_reads_it_is_not_installed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "robots.model.meshes.mesh_solids", None)
    (defect,) = MODELS.mesh_defects(tmp_path / "a.stl", scale=1.0)
    assert (defect.unusable, defect.hint) == (True, "pip install 'flexcell[sim]'")
