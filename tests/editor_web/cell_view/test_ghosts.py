"""What somebody looks at before an arm goes there: beside what is planned, and gone when nobody looks."""

from __future__ import annotations

import asyncio

import viser

from editor_web.cell_view import CellView
from editor_web.cell_view.newest import Newest
from editor_web.cell_view.ways import Ghosts, Ways
from engine.skills.planning import PathPreview
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.fake_scene import frames_at, new_scene
from tests.editor_web.fake_sights import description, way
from tests.editor_web.viser_page import viser_page


def test_a_ghost_stands_beside_the_planned_way_and_goes_when_nobody_looks(server: viser.ViserServer) -> None:
    newest = Newest()
    for name, message in (("left", description("left")), ("cell", new_scene()), ("cell", frames_at(0.0))):
        newest.put(name, message)
    newest.put("left", way("left", "moving"))
    newest.put_ghost(way("left"))
    newest.put_ghost(way("left"), place=2)
    planned, ghosts = Ways(server), Ghosts(server)
    planned.draw(newest, 0.0, is_shown=True)
    ghosts.draw(newest, 0.0)
    for node in ("/ways/left", "/taught/left.0", "/taught/left.2"):
        assert server.scene.get_handle_by_name(f"{node}/line") is not None
        assert server.scene.get_handle_by_name(f"{node}/ghost") is not None
    newest.put_ghost(PathPreview(robot="left", state="none"))
    ghosts.draw(newest, 1.0)
    assert server.scene.get_handle_by_name("/taught/left.0/line") is None
    assert server.scene.get_handle_by_name("/taught/left.2/line") is not None
    ghost, planned_ghost = (
        server.scene.get_handle_by_name(f"{name}/ghost") for name in ("/taught/left.0", "/ways/left")
    )
    assert ghost is not None
    assert not ghost.visible
    assert planned_ghost is not None
    assert planned_ghost.visible


async def test_a_page_that_hides_planned_ways_sees_what_is_looked_at() -> None:
    """Somebody wants to see it just now."""
    backend = FakeBackend()
    for topic, message in (
        ("cell/scene", new_scene()),
        ("cell/frames", frames_at(0.0)),
        ("left/description", description("left")),
        ("left/planned_path", way("left", "moving")),
    ):
        backend.publish(topic, message)
    view = CellView(backend, shadows=False)
    await asyncio.to_thread(view.open)
    await view.subscribe()
    try:
        view.show("mine", frozenset({"voxels"}))
        async with viser_page(view, "mine") as page:
            view.show_ghost(way("left"), place=1)
            await page.until(lambda: page.is_seen("/taught/left.1/line") and not page.is_seen("/ways/left/line"))
            view.show_ghost(PathPreview(robot="left", state="none"), place=1)
            await page.until(lambda: not page.is_seen("/taught/left.1/line"))
    finally:
        await view.unsubscribe()
        await asyncio.to_thread(view.close)
