"""What the voxels of an occupancy map cost in the 3D view: `python -P benchmarks/voxel_view.py [--seconds N]`.

Grids of 64 x 90 x 60 voxels, every one another, ten a second, through bus, viser and our proxy to a Chromium that
draws them; without a graphics card it draws in software. Every voxel is on the surface and stands at random, which
is the worst case for what is sent.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import tempfile
import threading
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from playwright.sync_api import Page, sync_playwright

from benchmarks.login_link import login_link
from benchmarks.process_cpu import cpu_s
from editor_web.cell_view.layers.occupancy import PERIOD_S, VoxelLayer
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.viser_gateway import new_viser_server
from editor_web.server import dashboard
from engine.cell.open_cell import OpenCell
from engine.journal import Journal
from engine.messages import SceneDescription, VisualGeometry
from engine.messages.sensing import OccupancyGrid
from engine.project.session import Session
from tests.editor_web.browsing import browser_program

SHAPE = (64, 90, 60)
_FRAMES = 30
_WARM_UP_S = 4.0
_COUNT_FRAMES = "() => { window.drawn = 0; const on = () => { drawn += 1; requestAnimationFrame(on) }; on() }"
_PAGE_NOW = "() => [performance.now() / 1000, window.drawn, performance.memory.usedJSHeapSize / 1e6]"


@dataclass(frozen=True, kw_only=True)
class Row:
    """One line of the table: milliseconds of the drawing thread, shares of a core, megabytes, frames a second."""

    voxels: int
    draw_p50_ms: float
    draw_p99_ms: float
    server_cpu: float
    server_grew_mb: float
    page_fps: float
    page_grew_mb: float


def new_grids(voxels: int) -> list[OccupancyGrid]:
    """Return grids with `voxels` taken, none of which touches another by a side."""
    generator = np.random.default_rng(voxels)
    apart = np.flatnonzero(np.indices(SHAPE).sum(axis=0) % 2 == 0)
    grids: list[OccupancyGrid] = []
    for frame in range(_FRAMES):
        taken = np.zeros(SHAPE, dtype=np.bool_)
        taken.flat[generator.choice(apart, voxels, replace=False)] = True
        bits = np.packbits(taken).tobytes()
        grids.append(
            OccupancyGrid(
                time_s=0.0, revision=frame, corner_m=(-0.64, -0.9, 0.0), voxel_m=0.02, shape=SHAPE, occupied=bits
            )
        )
    return grids


def draw_times_ms(grids: list[OccupancyGrid]) -> list[float]:
    """Return the CPU time that the drawing thread spends on each grid, without anybody who looks."""
    server = new_viser_server("key")
    try:
        voxels, latest, spent = VoxelLayer(server), LatestMessages(), list[float]()
        for number, grid in enumerate(grids * 4):
            latest.put("cell", grid)
            started_s = time.thread_time()
            voxels.draw(latest, number * PERIOD_S)
            spent.append((time.thread_time() - started_s) * 1e3)
        return spent[_FRAMES:]
    finally:
        server.stop()


async def measured(voxels: int, *, seconds: float, folder: Path) -> Row:
    """Let a page look on for so long."""
    grids = new_grids(voxels)
    spent = draw_times_ms(grids)
    table = VisualGeometry(name="table", frame="world", kind="box", size_m=(1.6, 2.0, 0.04), xyz=(0.0, 0.0, -0.02))
    with Journal.open(folder) as journal:
        async with OpenCell(None) as cell, Session(cell, project=folder, catalogue={}, journal=journal) as session:
            cell.bus.topic("cell/scene", SceneDescription).publish(SceneDescription(geometries=(table,)))
            topic = cell.bus.topic("cell/occupancy", OccupancyGrid)
            async with dashboard(session, token_file=folder / "tokens", shadows=False) as running:
                page = _Page(running.url, running.token, seconds=seconds)
                browsing = asyncio.create_task(asyncio.to_thread(page.look), name="page")
                used_s, resident = 0.0, 0.0
                number = 0
                while not browsing.done():
                    topic.publish(grids[number % len(grids)])
                    if page.started.is_set() and resident == 0.0:
                        used_s, resident = cpu_s(os.getpid()), _resident_mb()
                    number += 1
                    await asyncio.sleep(PERIOD_S)
                await browsing
                used_s, grew_mb = cpu_s(os.getpid()) - used_s, _resident_mb() - resident
    return Row(
        voxels=voxels,
        draw_p50_ms=float(np.percentile(spent, 50)),
        draw_p99_ms=float(np.percentile(spent, 99)),
        server_cpu=used_s / seconds,
        server_grew_mb=grew_mb,
        page_fps=page.fps,
        page_grew_mb=page.grew_mb,
    )


class _Page:
    """A page that looks at the view, and counts what it draws."""

    def __init__(self, url: str, token: str, *, seconds: float) -> None:
        self._url, self._token, self._seconds = url, token, seconds
        self.started = threading.Event()
        self.fps = 0.0
        self.grew_mb = 0.0

    def look(self) -> None:
        """On a thread of its own."""
        with sync_playwright() as playwright:
            arguments = ["--no-sandbox", "--enable-precise-memory-info", "--js-flags=--expose-gc"]
            browser = playwright.chromium.launch(executable_path=browser_program(), args=arguments)
            page = browser.new_page(locale="en-US", viewport={"width": 640, "height": 480})
            page.goto(login_link(self._url, self._token))
            page.goto(f"{self._url}cell/")
            page.locator("canvas[data-engine]").wait_for(timeout=60_000)
            page.wait_for_timeout(_WARM_UP_S * 1e3)
            page.evaluate(_COUNT_FRAMES)
            before = _of_page(page)
            self.started.set()
            page.wait_for_timeout(self._seconds * 1e3)
            after = _of_page(page)
            self.fps = (after[1] - before[1]) / (after[0] - before[0])
            self.grew_mb = after[2] - before[2]
            browser.close()


def _of_page(page: Page) -> tuple[float, float, float]:
    page.evaluate("() => gc()")
    seconds, frames, heap_mb = page.evaluate(_PAGE_NOW)
    return float(seconds), float(frames), float(heap_mb)


def _resident_mb() -> float:
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=30.0, help="how long the page looks on (default 30)")
    options = parser.parse_args()
    print("| voxels | drawing thread p50 | p99 | server CPU | server grew | page draws | page's heap grew |")
    print("|---|---|---|---|---|---|---|")
    for voxels in (0, 5_000, 20_000):
        with tempfile.TemporaryDirectory() as folder:
            row = asyncio.run(measured(voxels, seconds=options.seconds, folder=Path(folder)))
        print(
            f"| {row.voxels} | {row.draw_p50_ms:.1f} ms | {row.draw_p99_ms:.1f} ms | {row.server_cpu:.0%} | "
            f"{row.server_grew_mb:+.1f} MB | {row.page_fps:.0f} fps | {row.page_grew_mb:+.1f} MB |",
            flush=True,
        )


if __name__ == "__main__":
    main()
