"""The bodies of the cell: each in its group, drawn once, moved when it moves."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest
import viser

from editor_web.cell_view.layers.bodies import BodyLayer, body_node
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from engine.messages import FramePoses, VisualGeometry
from engine.skills.jogging import JogBlock
from tests.editor_web.fake_sights import description, frames_with_a_person, planned_path, scene_with_a_person


def messages_at(time_s: float) -> LatestMessages:
    """The fake cell with a person, before any arm has said what it is."""
    made = LatestMessages()
    made.put("cell", scene_with_a_person())
    made.put("cell", frames_with_a_person(time_s))
    return made


def is_there(server: viser.ViserServer, *nodes: str) -> list[bool]:
    """Which nodes are drawn."""
    return [server.scene.get_handle_by_name(node) is not None for node in nodes]


@pytest.mark.parametrize(
    ("frame", "node"),
    [
        ("world", "/cell/world"),
        ("plate", "/cell/plate"),
        ("left/link1", "/cell/left.link1"),
        ("anna/hand", "/people/anna.hand"),
    ],
)
def test_bodies_of_neither_an_arm_nor_the_cell_are_those_of_people(frame: str, node: str) -> None:
    assert body_node(frame, frozenset({"left", "right"})) == node
    assert body_node(frame, frozenset()).startswith("/cell/")


def test_a_part_of_a_module_is_no_person_though_its_name_begins_with_neither_arm(server: viser.ViserServer) -> None:
    bodies, newest = BodyLayer(server), messages_at(0.0)
    for arm in ("left", "right"):
        newest.put(arm, description(arm))
    scene = scene_with_a_person()
    block = VisualGeometry(name="bin/block", frame="bin/block", kind="sphere", size_m=(0.1,), rgba=(0.5, 0.5, 0.5, 1.0))
    newest.put("cell", msgspec.structs.replace(scene, geometries=(*scene.geometries, block)))
    bodies.draw(newest)
    assert is_there(server, "/cell/bin.block", "/people/bin.block", "/people/anna.hand") == [True, False, True]


def test_people_find_their_group_once_the_arms_are_known(server: viser.ViserServer) -> None:
    bodies, newest = BodyLayer(server), messages_at(0.0)
    bodies.draw(newest)
    assert is_there(server, "/cell/anna.hand", "/people/anna.hand", "/frames/left.tool") == [True, False, False]
    for arm in ("left", "right"):
        newest.put(arm, description(arm))
    bodies.draw(newest)
    assert is_there(server, "/cell/anna.hand", "/people/anna.hand", "/frames/world") == [False, True, True]


def colours(server: viser.ViserServer) -> dict[str, tuple[int, ...]]:
    """The colours of the table, a tray, and the links of both arms."""
    nodes = {"table": "world/0", "tray": "world/1", "left/fore": "left.fore/5", "right/fore": "right.fore/8"}
    found: dict[str, tuple[int, ...]] = {}
    for name, node in nodes.items():
        shape = server.scene.get_handle_by_name(f"/cell/{node}")
        assert isinstance(shape, viser.BoxHandle)
        found[name] = tuple(shape.color)
    return found


def test_the_two_bodies_that_would_touch_are_red_until_the_way_is_free(server: viser.ViserServer) -> None:
    bodies, newest = BodyLayer(server), messages_at(0.0)
    for arm in ("left", "right"):
        newest.put(arm, description(arm))
    bodies.draw(newest)
    plain = colours(server)
    newest.put("left", planned_path("left", "blocked", reason="left/fore would touch tray_north and 1 more"))
    bodies.draw(newest)
    assert {name for name, colour in colours(server).items() if colour != plain[name]} == {"left/fore", "tray"}
    newest.put("left", planned_path("left", "blocked", reason="left/fore would touch right/fore"))
    bodies.draw(newest)
    assert {name for name, colour in colours(server).items() if colour != plain[name]} == {"left/fore", "right/fore"}
    newest.put("left", planned_path("left", "moving"))
    bodies.draw(newest)
    assert colours(server) == plain


def test_the_two_bodies_between_which_a_jog_stands_are_red_until_it_goes_free(server: viser.ViserServer) -> None:
    bodies, newest = BodyLayer(server), messages_at(0.0)
    for arm in ("left", "right"):
        newest.put(arm, description(arm))
    bodies.draw(newest)
    plain = colours(server)
    newest.put("left", JogBlock(robot="left", first="left/fore", second="tray_north", distance_m=0.005))
    bodies.draw(newest)
    assert {name for name, colour in colours(server).items() if colour != plain[name]} == {"left/fore", "tray"}
    newest.put("left", JogBlock(robot="left"))
    bodies.draw(newest)
    assert colours(server) == plain


def test_what_is_drawn_once_is_only_moved(server: viser.ViserServer) -> None:
    bodies, newest = BodyLayer(server), messages_at(0.0)
    bodies.draw(newest)
    table, fore = (server.scene.get_handle_by_name(f"/cell/{name}") for name in ("world/0", "left.fore"))
    assert fore is not None
    before = np.array(fore.position)
    moved = frames_with_a_person(0.5)
    newest.put("cell", moved)
    bodies.draw(newest)
    assert server.scene.get_handle_by_name("/cell/world/0") is table
    assert not np.allclose(fore.position, before)
    assert np.allclose(fore.position, moved.xyz[moved.names.index("left/fore")])


def with_arm_at(poses: FramePoses, *, aside_m: float, about_z_rad: float = 0.0) -> FramePoses:
    """The frames with the fore arm of the left arm so far aside and turned."""
    row = poses.names.index("left/fore")
    x, y, z = poses.xyz[row]
    xyz, xyzw = list(poses.xyz), list(poses.xyzw)
    xyz[row] = (x + aside_m, y, z)
    xyzw[row] = (0.0, 0.0, math.sin(about_z_rad / 2), math.cos(about_z_rad / 2))
    return msgspec.structs.replace(poses, xyz=tuple(xyz), xyzw=tuple(xyzw))


def test_a_resting_arm_with_noise_sends_nothing_and_a_slow_motion_arrives(server: viser.ViserServer) -> None:
    """Noise of 0.05 mm and 0.05 mrad; then steps of 0.01 mm and of 0.01 mrad, each of which nobody sees."""
    bodies, newest = BodyLayer(server), messages_at(0.0)
    bodies.draw(newest)
    rest = with_arm_at(frames_with_a_person(0.0), aside_m=0.0)
    newest.put("cell", rest)
    bodies.draw(newest)
    fore = server.scene.get_handle_by_name("/cell/left.fore")
    assert isinstance(fore, viser.FrameHandle)

    def drawn_at(poses: FramePoses) -> tuple[float, float]:
        newest.put("cell", poses)
        bodies.draw(newest)
        return float(fore.position[0]), 2.0 * math.asin(float(fore.wxyz[3]))

    drawn = {drawn_at(with_arm_at(rest, aside_m=at * 5e-5, about_z_rad=-at * 5e-5)) for at in (1, -1, 0, -1, 1)}
    assert len(drawn) == 1
    start_m, start_rad = drawn.pop()
    for step in range(101):
        now_m, now_rad = drawn_at(with_arm_at(rest, aside_m=step * 1e-5, about_z_rad=step * 1e-5))
        assert now_m - start_m == pytest.approx(step * 1e-5, abs=2.2e-4)
        assert now_rad - start_rad == pytest.approx(step * 1e-5, abs=2.2e-4)


def test_the_first_look_has_the_whole_cell_in_it(server: viser.ViserServer) -> None:
    BodyLayer(server).draw(messages_at(0.0))
    camera = server.initial_camera
    away_m = float(np.linalg.norm(np.subtract(camera.position, camera.look_at)))
    half_table_m = float(np.hypot(0.8, 0.6))
    assert np.tan(camera.fov / 2) * away_m > half_table_m
