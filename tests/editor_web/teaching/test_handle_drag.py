"""An arm is moved and pushed by a handle in the 3D view, and rests however the hand lets go."""

from __future__ import annotations

import asyncio
import json
import math
from collections.abc import AsyncGenerator, Callable, Generator
from contextlib import asynccontextmanager
from itertools import count
from typing import Any

import pytest
import websockets.asyncio.client
from viser import TransformControlsHandle
from websockets.exceptions import ConnectionClosed, InvalidStatus

from editor_web.security.authentication import OPERATOR, VIEWER, Role
from editor_web.security.middleware import cookie_name
from engine.bus.json_bus import CLI_HOLDER
from engine.messages import FramePoses, JointState, Vector3
from engine.skills.guiding import FinishGuiding, GuideArm
from tests.editor_web.limits import GUARD_S
from tests.editor_web.teach_site import TeachSite
from tests.editor_web.viser_page import VISER, ViserPage

PAGES = count(1)
"""A page of its own for each hand: the handle of the one before may not have gone yet."""
HANDLE = "/handle"
RESTS_RAD_S = 0.01
MOST_PULLS = 4
REST_S = 0.6
"""Deadman of the page, then watchdog of the arm, then braking; on a machine that does much else."""
Socket = websockets.asyncio.client.ClientConnection


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory, loopback: str) -> Generator[TeachSite]:
    with TeachSite(host=loopback, project=tmp_path_factory.mktemp("gripped"), view=True) as opened:
        yield opened


class Hand:
    """A page with its 3D view and its grip, and the mouse on it."""

    def __init__(self, site: TeachSite, page: str, view: ViserPage, grip: Socket) -> None:
        self.site, self.page, self.view, self.grip = site, page, view, grip
        self._holding: asyncio.Task[None] | None = None

    async def say(self, **message: object) -> None:
        await self.grip.send(json.dumps(message))

    async def message(self, kind: str, **fields: object) -> dict[str, Any]:
        async with asyncio.timeout(GUARD_S):
            while True:
                news = json.loads(await self.grip.recv())
                assert kind == "refused" or news["k"] != "refused", news
                if news["k"] == kind and all(news[name] == value for name, value in fields.items()):
                    return news

    async def take(self, mode: str = "move", arm: str = "left") -> None:
        """Take the handle, and wait until it is seen."""
        await self.say(k="take", arm=arm, mode=mode)
        await self.message("gripped", arm=arm)
        await self.view.until(lambda: self.view.is_seen(HANDLE))

    async def grab(self) -> Vector3:
        """Press the mouse on the handle, and wait until that is heard; returns where it is."""
        await self.view.send("TransformControlsDragStartMessage", name=HANDLE, owner=self.view.owner(HANDLE))
        self._holding = asyncio.create_task(self._hold())
        await self.message("gripped", pulled=True)
        return self.tool()

    async def pull(self, to: Vector3, *, until: Callable[[Vector3], bool]) -> None:
        """Move the held handle until the tool is somewhere.

        A loaded machine that starves the arm lets it rest and says so: it is pulled again, as people do.
        """
        news: list[object] = []
        for _ in range(MOST_PULLS):
            await self.drag(to)
            arrived = asyncio.create_task(frames_seen(self.site, until))
            refused = asyncio.create_task(self.message("refused"))
            await asyncio.wait({arrived, refused}, return_when=asyncio.FIRST_COMPLETED)
            is_there = arrived.done()
            for task in (arrived, refused):
                task.cancel()
            await asyncio.wait({arrived, refused})
            if is_there:
                return arrived.result()
            news.append(refused.result())
            await self.message("gripped", pulled=False)
            await self.release()
            await self.grab()
        raise AssertionError(f"let go {MOST_PULLS} times: {news}")

    async def drag(self, to: Vector3) -> None:
        """Move the handle."""
        await self.view.send(
            "TransformControlsUpdateMessage",
            name=HANDLE,
            owner=self.view.owner(HANDLE),
            wxyz=self._wxyz(),
            position=to,
        )

    async def release(self) -> None:
        """Let the mouse go."""
        await self.fall_silent()
        await self.view.send("TransformControlsDragEndMessage", name=HANDLE, owner=self.view.owner(HANDLE))

    async def fall_silent(self) -> None:
        """Say no more that the mouse is down."""
        if self._holding is not None:
            self._holding.cancel()
            await asyncio.wait({self._holding})
            self._holding = None

    def tool(self) -> Vector3:
        """Where the tool is."""
        frames = self._frames()
        return frames.xyz[frames.names.index(self._tool_frame())]

    def _wxyz(self) -> tuple[float, ...]:
        frames = self._frames()
        x, y, z, w = frames.xyzw[frames.names.index(self._tool_frame())]
        return (w, x, y, z)

    def _frames(self) -> FramePoses:
        latest = self.site.on_loop(lambda: self.site.bus.find_topic("cell/frames").latest)
        assert isinstance(latest, FramePoses)
        return latest

    def _tool_frame(self) -> str:
        latest: Any = self.site.on_loop(lambda: self.site.bus.find_topic("left/description").latest)
        return latest.tool_frame

    async def _hold(self) -> None:
        while True:
            await self.say(k="held")
            await asyncio.sleep(0.05)


def cookie(site: TeachSite, role: Role = OPERATOR) -> dict[str, str]:
    return {"Cookie": f"{cookie_name(site.running.port)}={site.running.sessions.begin(role)}"}


def connect(site: TeachSite, path: str, *, role: Role = OPERATOR, **options: Any) -> websockets.asyncio.client.connect:
    origin = site.running.url.rstrip("/")
    return websockets.asyncio.client.connect(
        f"{origin.replace('http', 'ws', 1)}{path}",
        additional_headers=cookie(site, role),
        origin=websockets.Origin(origin),
        max_size=None,
        max_queue=None,
        compression=None,
        proxy=None,
        **options,
    )


@asynccontextmanager
async def hand_at(site: TeachSite) -> AsyncGenerator[Hand]:
    """A page that looks at the arm, which stands at home."""
    await asyncio.to_thread(lambda: site.call(site.let_go()))
    await asyncio.to_thread(lambda: site.call(site.go_home()))
    page = f"grip{next(PAGES)}"
    async with (
        connect(site, f"/cell/{page}/", subprotocols=[VISER]) as socket,
        connect(site, f"/api/v1/cell/grip/{page}") as grip,
    ):
        view = ViserPage(socket=socket)
        await view.send_camera()
        hand = Hand(site, page, view, grip)
        yield hand
        await hand.fall_silent()


async def seen(site: TeachSite, topic: str, condition: Callable[[Any], bool]) -> None:
    """Wait for a message of a topic of the server."""

    async def until() -> None:
        found = site.bus.find_topic(topic)
        async with asyncio.timeout(GUARD_S):
            with found.stream() as stream:
                while found.latest is None or not condition(found.latest):
                    await stream.next()

    await asyncio.wrap_future(asyncio.run_coroutine_threadsafe(until(), site.loop))


async def frames_seen(site: TeachSite, condition: Callable[[Vector3], bool]) -> None:
    """Wait until the tool is somewhere."""
    description: Any = site.on_loop(lambda: site.bus.find_topic("left/description").latest)

    def fits(frames: FramePoses) -> bool:
        return condition(frames.xyz[frames.names.index(description.tool_frame)])

    await seen(site, "cell/frames", fits)


def below(point: Vector3, way_m: float) -> Vector3:
    x, y, z = point
    return (x, y, z - way_m)


def fastest(state: JointState) -> float:
    return max(map(abs, state.velocity_rad_s))


async def time_to_rest_s(site: TeachSite) -> float:
    """The time of the simulated world until no joint moves."""
    began = await site.seen(lambda _: True)
    rested = await site.seen(lambda state: fastest(state) < RESTS_RAD_S)
    return rested.time_s - began.time_s


@asynccontextmanager
async def moving(site: TeachSite) -> AsyncGenerator[Hand]:
    """A hand that pulls the tool down by 30 cm, which takes three seconds; it has just begun to move."""
    async with hand_at(site) as hand:
        await hand.take()
        began = await hand.grab()
        await hand.drag(below(began, 0.3))
        await site.seen(lambda state: fastest(state) > 0.05)
        yield hand


async def test_the_tool_follows_the_handle_and_the_handle_comes_back_to_the_tool(site: TeachSite) -> None:
    async with hand_at(site) as hand:
        await hand.take()
        began = await hand.grab()
        target = below(began, 0.04)
        await hand.pull(target, until=lambda tool: math.dist(tool, target) < 0.003)
        await hand.drag(below(began, 0.2))
        await hand.release()
        await hand.message("gripped", pulled=False)
        await site.seen(lambda state: fastest(state) < RESTS_RAD_S)
        rest = hand.tool()
        assert rest[2] > began[2] - 0.1
        await hand.view.until(lambda: math.dist(_shown(hand.view), rest) < 0.002)


def _shown(view: ViserPage) -> tuple[float, ...]:
    node = view.node(HANDLE)
    return node.position if node is not None else (math.inf,) * 3


async def test_the_handle_is_seen_only_once_somebody_listens_to_it(
    site: TeachSite, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen_before: list[bool] = []
    listen: Any = TransformControlsHandle.on_update

    def noted(control: TransformControlsHandle, heard: Any) -> Any:
        seen_before.append(control.visible)
        return listen(control, heard)

    monkeypatch.setattr(TransformControlsHandle, "on_update", noted)
    async with hand_at(site) as hand:
        await hand.take()
    assert seen_before == [False]


async def test_the_arm_rests_when_the_mouse_is_let_go(site: TeachSite) -> None:
    async with moving(site) as hand:
        await hand.release()
        assert await time_to_rest_s(site) < REST_S


async def test_the_arm_rests_when_the_page_falls_silent_with_the_mouse_down(site: TeachSite) -> None:
    async with moving(site) as hand:
        await hand.fall_silent()
        assert await time_to_rest_s(site) < REST_S


async def test_the_arm_rests_when_the_3d_view_is_cut_off(site: TeachSite) -> None:
    async with moving(site) as hand:
        hand.view.socket.transport.abort()
        assert await time_to_rest_s(site) < REST_S


async def test_the_arm_rests_when_the_page_is_cut_off(site: TeachSite) -> None:
    async with moving(site) as hand:
        await hand.fall_silent()
        hand.grip.transport.abort()
        assert await time_to_rest_s(site) < REST_S


async def test_the_arm_rests_when_the_handle_is_put_away(site: TeachSite) -> None:
    async with moving(site) as hand:
        await hand.say(k="take", arm="")
        assert await time_to_rest_s(site) < REST_S
        await hand.view.until(lambda: not hand.view.is_seen(HANDLE))


async def test_pulling_alone_moves_nothing_without_a_page_that_holds(site: TeachSite) -> None:
    """What viser says does not do: somebody could send that without a mouse."""
    async with hand_at(site) as hand:
        await hand.take()
        began = hand.tool()
        await hand.view.send("TransformControlsDragStartMessage", name=HANDLE, owner=hand.view.owner(HANDLE))
        for _ in range(20):
            await hand.drag(below(began, 0.3))
            await asyncio.sleep(0.05)
        assert math.dist(hand.tool(), began) < 0.02


async def test_an_arm_that_floats_is_pushed_and_is_let_go(site: TeachSite) -> None:
    async with hand_at(site) as hand:
        guiding = asyncio.run_coroutine_threadsafe(_guide(site), site.loop)
        await seen(site, "left/status", lambda status: status.mode == "guiding")
        await hand.take("push")
        began = await hand.grab()
        x, y, z = began
        await hand.pull((x, y + 0.1, z), until=lambda tool: tool[1] > y + 0.03)
        await hand.release()
        await hand.message("gripped", pulled=False)
        await asyncio.to_thread(lambda: site.call(site.bus.call(FinishGuiding(), to="left", holder=CLI_HOLDER)))
        await asyncio.wrap_future(guiding)


async def _guide(site: TeachSite) -> None:
    await site.bus.send_goal(GuideArm(), to="left", holder=CLI_HOLDER).result()
    site.bus.leases.release_run(CLI_HOLDER.run)


async def test_an_arm_that_holds_itself_is_not_pushed(site: TeachSite) -> None:
    async with hand_at(site) as hand:
        await hand.take("push")
        await hand.grab()
        assert (await hand.message("refused"))["message"] == "the arm is not in hand guiding"


async def test_an_arm_that_there_is_not_has_no_handle(site: TeachSite) -> None:
    async with hand_at(site) as hand:
        await hand.say(k="take", arm="third")
        assert (await hand.message("refused"))["message"] == "there is no such arm"


async def test_a_viewer_has_no_handle_not_even_under_the_name_of_an_operators_page(site: TeachSite) -> None:
    with pytest.raises((InvalidStatus, ConnectionClosed)):
        async with connect(site, f"/api/v1/cell/grip/grip{next(PAGES)}", role=VIEWER) as socket:
            await socket.recv()
    async with (
        hand_at(site) as hand,
        connect(site, f"/cell/{hand.page}/", role=VIEWER, subprotocols=[VISER]) as other,
    ):
        viewer = ViserPage(socket=other)
        await viewer.send_camera()
        await hand.take()
        await viewer.until(lambda: viewer.is_seen("/cell"))
        await viewer.idle()
        assert viewer.node(HANDLE) is None


@pytest.mark.parametrize(
    "message", ["", "[]", '{"k": "take", "arm": 3}', '{"k": "take", "arm": "left", "mode": "fly"}']
)
async def test_what_is_no_message_ends_the_connection(site: TeachSite, message: str) -> None:
    async with connect(site, f"/api/v1/cell/grip/grip{next(PAGES)}") as grip:
        await grip.send(message)
        with pytest.raises(ConnectionClosed):
            await grip.recv()
