"""What somebody looks at before an arm goes there: beside what is planned, and gone when nobody looks."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager

import pytest
import viser

from editor_web.cell_view import NO_MARKS, CellView, Marks
from editor_web.cell_view.layers.marks import MarkedBody, MarkLayer
from editor_web.cell_view.layers.path_view import GhostLayer, PathLayer
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from engine.skills.planning import PathPreview
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.fake_scene import frames_at, new_scene
from tests.editor_web.fake_sights import description, planned_path
from tests.editor_web.viser_page import opened_view, viser_page

TURNED = ((1.0, 2.0, 3.0), (1.0, 0.0, 0.0, 0.0))
NOBODY_LOOKS = PathPreview(robot="left", state="none")


def test_a_ghost_stands_beside_the_planned_way_and_goes_when_nobody_looks(server: viser.ViserServer) -> None:
    newest = LatestMessages()
    for name, message in (("left", description("left")), ("cell", new_scene()), ("cell", frames_at(0.0))):
        newest.put(name, message)
    newest.put("left", planned_path("left", "moving"))
    planned, ghosts = PathLayer(server), GhostLayer(server)
    planned.draw(newest, 0.0, is_shown=True)
    ghosts.draw({("left", 0): planned_path("left"), ("left", 2): planned_path("left")}, newest, 0.0)
    for node in ("/paths/left", "/taught/left.0", "/taught/left.2"):
        assert server.scene.get_handle_by_name(f"{node}/line") is not None
        assert server.scene.get_handle_by_name(f"{node}/ghost") is not None
    ghosts.draw({("left", 0): NOBODY_LOOKS}, newest, 1.0)
    assert server.scene.get_handle_by_name("/taught/left.0/line") is None
    assert server.scene.get_handle_by_name("/taught/left.2/line") is not None
    ghost, planned_ghost = (
        server.scene.get_handle_by_name(f"{name}/ghost") for name in ("/taught/left.0", "/paths/left")
    )
    assert ghost is not None
    assert not ghost.visible
    assert planned_ghost is not None
    assert planned_ghost.visible


@asynccontextmanager
async def opened() -> AsyncGenerator[CellView]:
    """The view of a cell in which one arm has planned a way."""
    backend = FakeBackend()
    for topic, message in (
        ("cell/scene", new_scene()),
        ("cell/frames", frames_at(0.0)),
        ("left/description", description("left")),
        ("left/planned_path", planned_path("left", "moving")),
    ):
        backend.publish(topic, message)
    async with opened_view(backend) as view:
        yield view


async def test_a_page_that_hides_planned_ways_sees_what_is_looked_at() -> None:
    """Somebody wants to see it just now."""
    async with opened() as view:
        view.show("mine", frozenset({"voxels"}))
        async with viser_page(view, "mine") as page:
            view.show_ghost("mine", planned_path("left"), place=1)
            await page.until(lambda: page.is_seen("/taught/left.1/line") and not page.is_seen("/paths/left/line"))
            view.show_ghost("mine", NOBODY_LOOKS, place=1)
            await page.until(lambda: not page.is_seen("/taught/left.1/line"))


async def test_only_the_page_that_asked_sees_a_ghost() -> None:
    """Each has its own, of the same arm at the same time; the one that asked nothing has none."""
    async with (
        opened() as view,
        viser_page(view, "mine") as mine,
        viser_page(view, "yours") as yours,
        viser_page(view, "theirs") as theirs,
    ):
        view.show_ghost("mine", planned_path("left"))
        view.show_ghost("yours", planned_path("left"), place=3)
        await mine.until(lambda: mine.is_seen("/taught/left.0/ghost"))
        await yours.until(lambda: yours.is_seen("/taught/left.3/ghost"))
        view.show_ghost("mine", NOBODY_LOOKS)
        await mine.until(lambda: not mine.is_seen("/taught/left.0/ghost"))
        await theirs.idle()
        assert yours.is_seen("/taught/left.3/ghost")
        assert not any(name.startswith("/taught/left.0") for name in yours.nodes)
        assert not any(name.startswith("/taught/") for name in theirs.nodes)


async def test_a_page_that_loads_its_view_again_still_sees_its_ghost() -> None:
    """As it does when the colours of the page change."""
    async with opened() as view:
        view.show_ghost("mine", planned_path("left"))
        for _ in range(2):
            async with viser_page(view, "mine") as page:
                await page.until(lambda page=page: page.is_seen("/taught/left.0/ghost"))


def test_marks_take_the_place_of_those_before(server: viser.ViserServer) -> None:
    """Points, then a box with the axes of a pose, then nothing."""
    layer = MarkLayer(server)
    layer.draw(Marks(points=((0.1, 0.2, 0.3), (0.4, 0.5, 0.6))))
    point = server.scene.get_handle_by_name("/taught/marks/1")
    assert point is not None
    assert tuple(point.position) == (0.4, 0.5, 0.6)
    layer.draw(Marks(box=((0.0, 0.0, 0.1), (0.2, 0.4, 0.3)), axes=((1.0, 2.0, 3.0), (1.0, 0.0, 0.0, 0.0))))
    assert server.scene.get_handle_by_name("/taught/marks/1") is None
    box = server.scene.get_handle_by_name("/taught/marks/box")
    axes = server.scene.get_handle_by_name("/taught/marks/axes")
    assert isinstance(box, viser.BoxHandle)
    assert axes is not None
    assert box.dimensions == pytest.approx((0.2, 0.4, 0.2))
    assert tuple(box.position) == pytest.approx((0.1, 0.2, 0.2))
    assert (tuple(axes.position), tuple(axes.wxyz)) == ((1.0, 2.0, 3.0), (0.0, 1.0, 0.0, 0.0))
    layer.draw(NO_MARKS)
    assert server.scene.get_handle_by_name("/taught/marks/box") is None


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (MarkedBody(shape="box", size_m=(0.4, 0.2, 0.1), pose=TURNED), {"dimensions": (0.4, 0.2, 0.1)}),
        (MarkedBody(shape="cylinder", size_m=(0.4, 0.1), pose=TURNED), {"radius": 0.2, "height": 0.1}),
        (MarkedBody(shape="sphere", size_m=(0.4,), pose=TURNED), {"radius": 0.2}),
    ],
    ids=lambda value: value.shape if isinstance(value, MarkedBody) else "",
)
def test_a_marked_body_stands_where_it_will_be(
    server: viser.ViserServer, body: MarkedBody, expected: dict[str, object]
) -> None:
    """Its size, its centre, and the rotation of its axes."""
    layer = MarkLayer(server)
    layer.draw(Marks(body=body))
    drawn = server.scene.get_handle_by_name("/taught/marks/body")
    assert drawn is not None
    assert {name: getattr(drawn, name) for name in expected} == expected
    assert tuple(drawn.position) == (1.0, 2.0, 3.0)
    assert body.shape == "sphere" or tuple(drawn.wxyz) == (0.0, 1.0, 0.0, 0.0)
    layer.draw(NO_MARKS)
    assert server.scene.get_handle_by_name("/taught/marks/body") is None


def test_a_marked_body_that_warns_has_another_colour(server: viser.ViserServer) -> None:
    """One that touches something."""
    layer, colours = MarkLayer(server), list[object]()
    for warns in (False, True):
        layer.draw(Marks(body=MarkedBody(shape="box", size_m=(0.1, 0.1, 0.1), pose=TURNED, warns=warns)))
        colours.append(getattr(server.scene.get_handle_by_name("/taught/marks/body"), "color", None))
    assert None not in colours
    assert colours[0] != colours[1]


async def test_only_the_page_that_asked_sees_marks() -> None:
    """They go when it asks for none."""
    async with opened() as view, viser_page(view, "mine") as mine, viser_page(view, "yours") as yours:
        view.show_marks("mine", Marks(points=((0.0, 0.0, 0.5),)))
        await mine.until(lambda: mine.is_seen("/taught/marks/0"))
        assert not yours.is_seen("/taught/marks/0")
        view.show_marks("mine", NO_MARKS)
        await mine.until(lambda: not mine.is_seen("/taught/marks/0"))
