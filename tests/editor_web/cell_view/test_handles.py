"""A handle at a pose of the world: drawn without any frame, told how it is dragged, for operators' pages only."""

from __future__ import annotations

import asyncio

from editor_web.cell_view import ROLE_HEADER, DragHandle, HandlePull
from editor_web.cell_view.rendering.transforms import WorldPose
from editor_web.security.authentication import OPERATOR, VIEWER
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.limits import GUARD_S
from tests.editor_web.viser_page import ViserPage, opened_view, viser_page

HANDLE = "/handle"
AT = WorldPose(xyz=(1.0, 2.0, 3.0), xyzw=(0.0, 0.0, 0.0, 1.0))


class Pulls:
    """What a handle tells, on the event loop."""

    def __init__(self) -> None:
        self.told = asyncio.Queue[HandlePull]()
        self._loop = asyncio.get_running_loop()

    def handle(self, at: WorldPose = AT) -> DragHandle:
        """A handle that tells this."""
        return DragHandle(
            turns=True, at=at, pulled=lambda pull: self._loop.call_soon_threadsafe(self.told.put_nowait, pull) and None
        )

    async def until_let_go(self) -> list[HandlePull]:
        """All that it has told up to the end of a drag."""
        async with asyncio.timeout(GUARD_S):
            pulls = [await self.told.get()]
            while pulls[-1].phase != "end":
                pulls.append(await self.told.get())
        return pulls


async def pull(page: ViserPage, xyz: tuple[float, float, float]) -> None:
    """Drag the handle and let it go, as a browser does."""
    await page.send("TransformControlsDragStartMessage", name=HANDLE, owner=page.owner(HANDLE))
    await page.send(
        "TransformControlsUpdateMessage", name=HANDLE, owner=page.owner(HANDLE), wxyz=(1.0, 0.0, 0.0, 0.0), position=xyz
    )
    await page.send("TransformControlsDragEndMessage", name=HANDLE, owner=page.owner(HANDLE))


async def test_a_handle_stands_at_its_pose_and_tells_how_it_is_dragged() -> None:
    """The one that is given next takes its place."""
    heard = Pulls()
    async with (
        opened_view(FakeBackend()) as view,
        viser_page(view, "mine", headers={ROLE_HEADER: OPERATOR}) as page,
    ):
        await page.send_camera()
        view.give_handle("mine", heard.handle())
        await page.until(lambda: page.is_seen(HANDLE))
        await page.until(lambda: (node := page.node(HANDLE)) is not None and node.position == AT.xyz)
        await pull(page, (1.0, 2.0, 3.5))
        pulls = await heard.until_let_go()
        assert (pulls[0].phase, pulls[-1].pose.xyz) == ("start", (1.0, 2.0, 3.5))
        again = heard.handle(WorldPose(xyz=(1.0, 2.0, 4.0), xyzw=AT.xyzw))
        view.give_handle("mine", again)
        await page.until(lambda: (node := page.node(HANDLE)) is not None and node.position == (1.0, 2.0, 4.0))
        view.take_handle("mine", again)
        await page.until(lambda: not page.is_seen(HANDLE))


async def test_a_viewer_gets_no_handle() -> None:
    async with (
        opened_view(FakeBackend()) as view,
        viser_page(view, "mine", headers={ROLE_HEADER: OPERATOR}) as mine,
        viser_page(view, "yours", headers={ROLE_HEADER: VIEWER}) as yours,
    ):
        await yours.send_camera()
        await mine.send_camera()
        view.give_handle("yours", Pulls().handle())
        view.give_handle("mine", Pulls().handle())
        await mine.until(lambda: mine.is_seen(HANDLE))
        await yours.idle()
        assert not yours.is_seen(HANDLE)
