"""A page sees a past moment of a run from its recording, and no other page does."""

from __future__ import annotations

import asyncio
import math
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from editor_web.cell_view import CellView, GhostRequest, PastViewState
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.fake_scene import frames_at, new_scene
from tests.editor_web.fake_sights import description, detections, occupancy, planned_path, planning_scene
from tests.editor_web.limits import GUARD_S
from tests.editor_web.past_recording import RecordedMessages, write_recording
from tests.editor_web.viser_page import ViserPage, viser_page

ARM = "/cell/left.fore"
PAST_ARM = f"/past{ARM}"
MOMENTS = tuple(step / 10 for step in range(101))


class Past:
    """Shows past moments to pages of a view, and waits until they are drawn."""

    def __init__(self, view: CellView) -> None:
        self.view = view
        self._loop = asyncio.get_running_loop()
        self._told: asyncio.Queue[PastViewState] = asyncio.Queue()

    async def show(self, page: str, run: str, time_s: float, *, ghost: GhostRequest | None = None) -> PastViewState:
        def report(state: PastViewState) -> None:
            self._loop.call_soon_threadsafe(self._told.put_nowait, state)

        self.view.show_past(page, run, time_s, report=report, ghost=ghost)
        async with asyncio.timeout(GUARD_S):
            while (state := await self._told.get()).time_s != time_s:
                pass
        return state


def recorded_messages() -> RecordedMessages:
    """Ten seconds of the fake cell; from 5 s on there are an obstacle, voxels and a planned way."""
    return {
        "left/description": [(0.0, description("left"))],
        "right/description": [(0.0, description("right"))],
        "cell/scene": [(0.0, new_scene())],
        "cell/frames": [(at_s, frames_at(at_s)) for at_s in MOMENTS],
        "cell/planning_scene": [(5.0, planning_scene())],
        "cell/occupancy": [(5.0, occupancy())],
        "left/planned_path": [(5.0, planned_path("left"))],
    }


@asynccontextmanager
async def opened(
    folder: Path, runs: dict[str, RecordedMessages] | None = None
) -> AsyncGenerator[tuple[FakeBackend, Past]]:
    """A view of a cell that stands at 0 s, and recordings of runs in it."""
    backend = FakeBackend()
    backend.publish("left/description", description("left"))
    backend.publish("right/description", description("right"))
    for run, content in (runs or {"run": recorded_messages()}).items():
        backend.recorded[run] = (write_recording(folder / f"{run}.mcap", content),)
    view = CellView(backend, shadows=False)
    await asyncio.to_thread(view.open)
    await view.subscribe()
    try:
        yield backend, Past(view)
    finally:
        await view.unsubscribe()
        await asyncio.to_thread(view.close)


def stands(page: ViserPage, node: str, time_s: float) -> bool:
    """Whether the arm of a page stands where it stood at a time."""
    frames = frames_at(time_s)
    expected = frames.xyz[frames.names.index("left/fore")]
    shown = page.node(node)
    return shown is not None and math.dist(shown.position, expected) < 1e-9


def has_body(page: ViserPage, node: str) -> bool:
    """Whether something is drawn at the node."""
    return any(page.is_seen(f"{node}/{index}") for index in range(30))


async def test_one_page_sees_the_past_and_the_others_the_present(tmp_path: Path) -> None:
    async with (
        opened(tmp_path) as (backend, past),
        viser_page(past.view, "one") as one,
        viser_page(past.view, "two") as two,
    ):
        for page in (one, two):
            await page.until(lambda page=page: page.is_seen(ARM) and has_body(page, ARM))
        state = await past.show("one", "run", 4.03)
        assert (state.problem, state.from_s, state.until_s) == ("", 0.0, 10.0)
        await one.until(lambda: one.is_seen(PAST_ARM) and stands(one, PAST_ARM, 4.0) and not one.is_seen(ARM))
        await one.until(lambda: has_body(one, PAST_ARM))
        backend.publish("cell/frames", frames_at(77.0))
        await two.until(lambda: stands(two, ARM, 77.0))
        assert two.is_seen(ARM)
        assert two.node(PAST_ARM) is None
        await past.show("one", "run", 8.0)
        await one.until(lambda: stands(one, PAST_ARM, 8.0))


async def test_a_page_comes_back_to_the_present_as_it_is_then(tmp_path: Path) -> None:
    async with opened(tmp_path) as (backend, past), viser_page(past.view, "one") as one:
        await past.show("one", "run", 4.0)
        await one.until(lambda: one.is_seen(PAST_ARM))
        backend.publish("cell/frames", frames_at(5.5))
        past.view.show_present("one")
        await one.until(lambda: one.is_seen(ARM) and not one.is_seen(PAST_ARM) and stands(one, ARM, 5.5))
        await past.show("one", "run", 6.0)
        await one.until(lambda: one.is_seen(PAST_ARM) and not one.is_seen(ARM) and stands(one, PAST_ARM, 6.0))


async def test_what_was_not_there_yet_is_not_shown(tmp_path: Path) -> None:
    things = ("/past/obstacles/post", "/past/voxels/occupied", "/past/paths/left/line")
    async with opened(tmp_path) as (_, past), viser_page(past.view, "one") as one:

        def seen() -> list[bool]:
            return [one.is_seen(name) for name in things]

        await past.show("one", "run", 7.0)
        await one.until(lambda: seen() == [True, True, True])
        await past.show("one", "run", 3.0)
        await one.until(lambda: seen() == [False, False, False])


async def test_detections_are_shown_at_the_instants_that_they_are_of(tmp_path: Path) -> None:
    """Before there were any, and a second after the last, there are none."""
    told: RecordedMessages = {
        **recorded_messages(),
        "above/detections": [(at_s, detections(time_s=at_s)) for at_s in (4.0, 5.0, 6.0)],
    }
    node = "/past/detections/above/cup.0"
    async with opened(tmp_path, {"run": told}) as (_, past), viser_page(past.view, "one") as one:
        for time_s, is_there in ((5.5, True), (3.0, False), (4.5, True), (8.0, False), (6.5, True)):
            await past.show("one", "run", time_s)
            await one.until(lambda is_there=is_there: one.is_seen(node) == is_there)


async def test_the_arms_of_another_run_are_ghosts_at_their_own_time(tmp_path: Path) -> None:
    """Only what moves: the table is the same. They go when nobody asks for them, and with the past."""
    ghost, table = "/past/ghost/left.fore", "/past/ghost/world"
    runs = {"run": recorded_messages(), "other": recorded_messages()}
    async with opened(tmp_path, runs) as (_, past), viser_page(past.view, "one") as one:
        state = await past.show("one", "run", 2.0, ghost=GhostRequest(run="other", time_s=5.0))
        assert (state.problem, state.ghost_problem) == ("", "")
        await one.until(lambda: stands(one, PAST_ARM, 2.0) and stands(one, ghost, 5.0) and has_body(one, ghost))
        await past.show("one", "run", 2.1, ghost=GhostRequest(run="other", time_s=5.1))
        await one.until(lambda: stands(one, PAST_ARM, 2.1) and stands(one, ghost, 5.1))
        assert not one.is_seen(table)
        await past.show("one", "run", 2.2)
        await one.until(lambda: stands(one, PAST_ARM, 2.2) and not one.is_seen(ghost))
        missing = await past.show("one", "run", 2.3, ghost=GhostRequest(run="none", time_s=1.0))
        assert (missing.problem, missing.ghost_problem) == ("", "this run has no recording")
        await past.show("one", "run", 2.4, ghost=GhostRequest(run="other", time_s=6.0))
        await one.until(lambda: one.is_seen(ghost) and stands(one, ghost, 6.0))
        past.view.show_present("one")
        await one.until(lambda: not one.is_seen(ghost))


async def test_a_page_hides_in_the_past_what_it_hides_in_the_present(tmp_path: Path) -> None:
    async with opened(tmp_path) as (_, past), viser_page(past.view, "one") as one:
        past.view.show("one", frozenset({"voxels"}))
        await past.show("one", "run", 7.0)
        line = "/past/paths/left/line"
        await one.until(lambda: one.is_seen("/past/voxels/occupied") and one.node(line) is not None)
        await one.until(lambda: not one.is_seen(line))
        past.view.show("one", frozenset({"paths"}))
        await one.until(lambda: one.is_seen("/past/paths/left/line") and not one.is_seen("/past/voxels/occupied"))


async def test_pages_see_different_instants_of_different_runs(tmp_path: Path) -> None:
    early: RecordedMessages = {"cell/scene": [(0.0, new_scene())], "cell/frames": [(0.0, frames_at(0.7))]}
    async with (
        opened(tmp_path, {"run": recorded_messages(), "early": early}) as (_, past),
        viser_page(past.view, "one") as one,
        viser_page(past.view, "two") as two,
    ):
        await past.show("one", "run", 2.0)
        await past.show("two", "run", 9.0)
        await one.until(lambda: stands(one, PAST_ARM, 2.0))
        await two.until(lambda: stands(two, PAST_ARM, 9.0))
        # Of another run nothing is left of the one before.
        await two.until(lambda: two.is_seen("/past/obstacles/post"))
        await past.show("two", "early", 9.0)
        await two.until(lambda: stands(two, PAST_ARM, 0.7) and not two.is_seen("/past/obstacles/post"))
        await one.idle()
        assert stands(one, PAST_ARM, 2.0)


async def test_a_page_that_loads_its_view_again_sees_the_moment_that_it_asked_for(tmp_path: Path) -> None:
    async with opened(tmp_path) as (_, past):
        async with viser_page(past.view, "one") as one:
            await past.show("one", "run", 2.0)
            await one.until(lambda: one.is_seen(PAST_ARM))
        async with viser_page(past.view, "one") as again:
            await again.until(lambda: again.is_seen(PAST_ARM) and stands(again, PAST_ARM, 2.0))
            await again.until(lambda: not again.is_seen(ARM))


async def test_a_run_under_way_is_seen_up_to_now(tmp_path: Path) -> None:
    async with opened(tmp_path) as (backend, past), viser_page(past.view, "one") as one:
        backend.recorded["now"] = (write_recording(tmp_path / "now.mcap", recorded_messages(), finished=False),)
        assert (await past.show("one", "now", 3.0)).until_s == 10.0
        await one.until(lambda: stands(one, PAST_ARM, 3.0))


async def test_a_resumed_run_has_the_instants_of_all_its_recordings(tmp_path: Path) -> None:
    later: RecordedMessages = {
        "cell/scene": [(20.0, new_scene())],
        "cell/frames": [(20.0 + at_s, frames_at(20.0 + at_s)) for at_s in MOMENTS],
    }
    async with opened(tmp_path) as (backend, past), viser_page(past.view, "one") as one:
        more = write_recording(tmp_path / "run~2.mcap", later, since_s=20.0)
        backend.recorded["run"] = (*backend.recorded["run"], more)
        for time_s, at_s in ((25.0, 25.0), (15.0, 10.0), (3.0, 3.0), (40.0, 30.0)):
            state = await past.show("one", "run", time_s)
            await one.until(lambda at_s=at_s: stands(one, PAST_ARM, at_s))
        assert (state.from_s, state.until_s) == (0.0, 30.0)


@pytest.mark.parametrize(("run", "problem"), [("none", "no recording"), ("broken", "damaged"), ("gone", "cannot read")])
async def test_what_cannot_be_shown_is_reported_and_the_page_stays_in_the_present(
    tmp_path: Path, run: str, problem: str
) -> None:
    (tmp_path / "broken.mcap").write_bytes(b"\x89MCAP0\r\n" + b"\xff" * 50)
    async with opened(tmp_path) as (backend, past), viser_page(past.view, "one") as one:
        backend.recorded["broken"] = (tmp_path / "broken.mcap",)
        backend.recorded["gone"] = (tmp_path / "gone.mcap",)
        await one.until(lambda: one.is_seen(ARM))
        assert problem in (await past.show("one", run, 1.0)).problem
        assert (await past.show("one", "run", 2.0)).problem == ""
        await one.until(lambda: one.is_seen(PAST_ARM))
        assert problem in (await past.show("one", run, 1.5)).problem
        await one.until(lambda: one.is_seen(ARM) and not one.is_seen(PAST_ARM))
