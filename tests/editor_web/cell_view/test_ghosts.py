"""What somebody looks at before an arm goes there: beside what is planned, and gone when nobody looks."""

from __future__ import annotations

import viser

from editor_web.cell_view.newest import Newest
from editor_web.cell_view.ways import Ways
from engine.skills.planning import PathPreview
from tests.editor_web.fake_scene import frames_at, new_scene
from tests.editor_web.fake_sights import description, way


def test_a_ghost_stands_beside_the_planned_way_and_goes_when_nobody_looks(server: viser.ViserServer) -> None:
    newest = Newest()
    for name, message in (("left", description("left")), ("cell", new_scene()), ("cell", frames_at(0.0))):
        newest.put(name, message)
    newest.put("left", way("left", "moving"))
    newest.put_ghost(way("left"))
    planned, ghosts = Ways(server), Ways(server, ghosts=True)
    for drawn in (planned, ghosts):
        drawn.draw(newest, 0.0, is_shown=True)
    for node in ("/ways/left", "/ways/taught/left"):
        assert server.scene.get_handle_by_name(f"{node}/line") is not None
        assert server.scene.get_handle_by_name(f"{node}/ghost") is not None
    newest.put_ghost(PathPreview(robot="left", state="none"))
    ghosts.draw(newest, 1.0, is_shown=True)
    assert server.scene.get_handle_by_name("/ways/taught/left/line") is None
    ghost, planned_ghost = (server.scene.get_handle_by_name(f"/ways/{name}/ghost") for name in ("taught/left", "left"))
    assert ghost is not None
    assert not ghost.visible
    assert planned_ghost is not None
    assert planned_ghost.visible
