"""The planning scene: what was put into it and what arms hold; nothing twice."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest
import viser

from editor_web.cell_view.layers.obstacles import ObstacleLayer
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.transforms import matrix_of_pose, poses_by_frame
from engine.messages import Pose, VisualGeometry
from engine.messages.shapes import Box, Hull, Obstacle, Solid
from tests.editor_web.fake_scene import frames_at, new_scene
from tests.editor_web.fake_sights import planned_path, planning_scene


@pytest.fixture
def messages() -> LatestMessages:
    """The fake cell with a planning scene."""
    made = LatestMessages()
    for message in (new_scene(), frames_at(0.0), planning_scene()):
        made.put("cell", message)
    return made


def colour(server: viser.ViserServer, name: str) -> tuple[int, ...]:
    """That of the first solid of an obstacle."""
    handle = server.scene.get_handle_by_name(f"/obstacles/{name}/0")
    assert isinstance(handle, viser.CylinderHandle | viser.BoxHandle)
    return tuple(handle.color)


def test_every_shape_is_drawn_but_what_the_scene_shows_anyway(
    server: viser.ViserServer, messages: LatestMessages
) -> None:
    ObstacleLayer(server).draw(messages)
    found = {
        name: server.scene.get_handle_by_name(f"/obstacles/{name}/0") is not None
        for name in ("post", "crate", "ball", "rail", "wedge", "cup", "table")
    }
    assert [name for name, is_there in found.items() if not is_there] == ["table"]


def test_what_stands_on_a_module_is_drawn_once_and_again_when_it_has_been_away(
    server: viser.ViserServer, messages: LatestMessages
) -> None:
    """A tray has several geometries, whose numbers are no names of bodies."""
    tray, block = (
        Obstacle(name=name, solids=(Solid(shape=Box(size_m=(0.1, 0.1, 0.1))),)) for name in ("bin/tray", "bin/block")
    )
    scene = new_scene()
    drawn = [
        VisualGeometry(name=name, frame=frame, kind="box", size_m=(0.1, 0.1, 0.1), rgba=(0.5, 0.5, 0.5, 1.0))
        for name, frame in (("bin/tray/0", "world"), ("bin/tray/1", "world"), ("bin/block", "bin/block"))
    ]
    messages.put("cell", msgspec.structs.replace(planning_scene(), obstacles=(tray, block), held=()))
    obstacles = ObstacleLayer(server)
    for geometries, expected in (((), [True, True]), (drawn, [False, False])):
        messages.put("cell", msgspec.structs.replace(scene, geometries=(*scene.geometries, *geometries)))
        obstacles.draw(messages)
        nodes = [server.scene.get_handle_by_name(f"/obstacles/{name}/0") for name in ("bin.tray", "bin.block")]
        assert [node is not None for node in nodes] == expected


def test_a_held_part_moves_with_the_link_that_holds_it(server: viser.ViserServer, messages: LatestMessages) -> None:
    obstacles = ObstacleLayer(server)
    for time_s in (0.0, 0.7):
        messages.put("cell", frames_at(time_s))
        obstacles.draw(messages)
        expected = matrix_of_pose(poses_by_frame(frames_at(time_s))["right/fore"]) @ np.array([0.0, 0.0, 0.44, 1.0])
        cup = server.scene.get_handle_by_name("/obstacles/cup")
        assert cup is not None
        assert np.allclose(cup.position, expected[:3])


def test_what_is_taken_out_of_the_scene_vanishes(server: viser.ViserServer, messages: LatestMessages) -> None:
    obstacles = ObstacleLayer(server)
    obstacles.draw(messages)
    messages.put("cell", msgspec.structs.replace(planning_scene(), revision=2, obstacles=(), held=()))
    obstacles.draw(messages)
    assert [n for n in ("post", "cup") if server.scene.get_handle_by_name(f"/obstacles/{n}/0")] == []


def test_what_a_blocked_way_names_stands_out_until_the_way_is_free(
    server: viser.ViserServer, messages: LatestMessages
) -> None:
    obstacles = ObstacleLayer(server)
    obstacles.draw(messages)
    plain = colour(server, "post")
    messages.put("left", planned_path("left", "blocked", reason="left/fore would touch post, not crates"))
    obstacles.draw(messages)
    assert colour(server, "post") != plain
    assert colour(server, "crate") == plain
    messages.put("left", planned_path("left", "moving"))
    obstacles.draw(messages)
    assert colour(server, "post") == plain


def test_a_part_that_moves_elsewhere_draws_no_obstacle_anew(
    server: viser.ViserServer, messages: LatestMessages
) -> None:
    obstacles = ObstacleLayer(server)
    obstacles.draw(messages)
    before = server.scene.get_handle_by_name("/obstacles/post/0")
    state = planning_scene()
    moved = tuple(
        msgspec.structs.replace(each, pose=Pose(xyz=(9.0, 0.0, 0.0))) if each.name == "table" else each
        for each in state.obstacles
    )
    messages.put("cell", msgspec.structs.replace(state, revision=2, obstacles=moved))
    obstacles.draw(messages)
    assert server.scene.get_handle_by_name("/obstacles/post/0") is before


def test_a_hull_that_is_none_leaves_the_others(
    server: viser.ViserServer, messages: LatestMessages, caplog: pytest.LogCaptureFixture
) -> None:
    flat = Obstacle.of("flat", Hull(points_m=((0.0, 0.0, 0.0),) * 4), Pose(xyz=(0.0, 0.0, 0.0)))
    state = planning_scene()
    messages.put("cell", msgspec.structs.replace(state, obstacles=(flat, *state.obstacles)))
    ObstacleLayer(server).draw(messages)
    assert "flat is not drawn" in caplog.text
    assert server.scene.get_handle_by_name("/obstacles/post/0") is not None
