"""The scene that a cell document gives: sizes, colours, jitter, refusals."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from engine.document.cell import CellDocument, MujocoWorld, load_cell
from engine.document.cell_bodies import Fixture, Spring
from engine.document.robot_spec import GripperSpec
from engine.errors import CellError
from robots.scene.scene_builder import build_scene
from robots.sim.physics.cell_model import build_cell

CELL = Path(__file__).parents[3] / "behaviors" / "cells" / "dual_panda.yaml"


@pytest.fixture(name="document")
def _document() -> CellDocument:
    return load_cell(CELL).document


def test_the_shipped_cell_compiles_with_both_arms_and_its_parts(document: CellDocument) -> None:
    cell = build_cell(build_scene(document))
    assert [arm.name for arm in cell.arms] == ["left", "right"]
    assert cell.parts == tuple(document.parts)


def test_a_seed_moves_parts_and_adding_a_part_moves_no_other(document: CellDocument) -> None:
    name = next(iter(document.parts))
    alone = msgspec.structs.replace(document, parts={name: document.parts[name]})
    (part,) = build_scene(alone, seed=3).parts
    assert part == build_scene(document, seed=3).parts[0]
    assert part.pose != build_scene(document).parts[0].pose


def test_the_realism_of_the_world_reaches_the_scene_with_the_seed_of_the_run(document: CellDocument) -> None:
    assert (build_scene(document, seed=3).realism, build_scene(document).seed) == ("typical", 0)
    poor = msgspec.structs.replace(document, world=MujocoWorld(realism="poor"))
    scene = build_scene(poor, seed=3)
    assert (scene.realism, scene.seed) == ("poor", 3)
    with pytest.raises(msgspec.ValidationError, match="Invalid enum value 'real'"):
        msgspec.convert({"kind": "mujoco", "realism": "real"}, MujocoWorld)


def test_a_part_taken_from_the_document_is_gone_from_the_world(document: CellDocument) -> None:
    assert build_cell(build_scene(msgspec.structs.replace(document, parts={}))).parts == ()


def left_alone(document: CellDocument, **changes: object) -> CellDocument:
    """Return the document with the left robot only, changed."""
    robot = msgspec.structs.replace(document.robots["left"], **changes)
    return msgspec.structs.replace(document, robots={"left": robot}, fixtures={}, parts={})


def test_a_gripper_that_there_is_none_of_is_refused_with_the_near_name(document: CellDocument) -> None:
    wanted = left_alone(document, gripper=GripperSpec(model="servo_clow"))
    with pytest.raises(CellError, match=r"robot left: there is no gripper model servo_clow \(did you mean servo_claw"):
        build_scene(wanted)


def test_the_tool_is_chosen_in_the_cell_document_or_left_out(document: CellDocument) -> None:
    def links(gripper: GripperSpec | None) -> set[str]:
        return {
            frame.removeprefix("left/")
            for frame in build_cell(build_scene(left_alone(document, gripper=gripper))).frames
        }

    bare, claw = links(None), links(GripperSpec(model="servo_claw"))
    assert bare < claw
    assert claw - bare == {"servo_claw_base", "servo_claw_left_finger", "servo_claw_right_finger", "servo_claw_tcp"}


def test_an_option_that_the_arm_does_not_have_is_refused(document: CellDocument) -> None:
    with pytest.raises(CellError, match="robot left: the joints of panda are not coupled"):
        build_scene(left_alone(document, coupled_joints=True))
    with pytest.raises(CellError, match="panda does not support calibration files"):
        build_scene(left_alone(document, calibration="x.yaml"))


def test_a_fixture_with_a_spring_gives_way(document: CellDocument) -> None:
    spring = Spring(stiffness_n_m=5000.0, friction=0.5)
    pad = Fixture(shape="box", size_m=(0.2, 0.2, 0.02), spring=spring)
    (body,) = build_scene(msgspec.structs.replace(document, fixtures={"pad": pad})).fixtures
    assert (body.spring_n_m, body.spring_ns_m, body.sprung_kg, body.skin_friction) == (5000.0, 60.0, 0.1, 0.5)
