"""What a behavior of 1,000 states costs on the page, each figure against its bar: `page.py [--states N] [--use-s S]`.

A real Chromium without a screen and without a graphics card opens `flexcell serve`, a process of its own, with a
generated behavior of 1,000 states in containers of 10 to 30. Frames are counted by `requestAnimationFrame` while the
canvas, or a node on it, follows the mouse. Needs the extras `all` and `test` and a Chromium.
"""

from __future__ import annotations

import argparse
import gzip
import os
import platform
import re
import shutil
import statistics
import sys
import tempfile
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, cast

from playwright.sync_api import Browser, Page, expect, sync_playwright

from benchmarks.large_document import large_document
from benchmarks.page_probe import PROBE
from benchmarks.page_tasks import start_recording, stop_recording
from benchmarks.served_dashboard import served_dashboard

ROOT = Path(__file__).parents[1]
STATIC = ROOT / "editor_web" / "static"
ID = "behaviors/large.yaml"
_BROWSERS = ("chromium", "chromium-browser", "google-chrome")
_LIMIT_MS = 30_000
_DRAG_S = 3.0


@dataclass(frozen=True, kw_only=True)
class Figure:
    """One line of the table; `bar` is the most, with `least` the least, that it may be."""

    name: str
    value: float
    unit: str
    bar: float | None = None
    least: bool = False

    @property
    def holds(self) -> bool:
        """True where it is within its bar."""
        return self.bar is None or (self.value >= self.bar if self.least else self.value <= self.bar)


@dataclass
class Trial:
    """One browser at one server; `figures` fill up."""

    browser: Browser
    login: str
    rounds: int
    use_s: float
    figures: list[Figure] = field(default_factory=list[Figure])

    @property
    def url(self) -> str:
        """Where the pages are."""
        return self.login.partition("/login")[0]

    def add(self, name: str, value: float, unit: str, bar: float | None = None, *, least: bool = False) -> None:
        """Keep a figure and show that there is progress."""
        self.figures.append(Figure(name=name, value=value, unit=unit, bar=bar, least=least))
        print(".", end="", file=sys.stderr, flush=True)


class Devtools:
    """What the browser says of a page."""

    def __init__(self, page: Page) -> None:
        # The methods of the protocol are untyped: Any contains them here.
        self._send = cast("Any", page.context.new_cdp_session(page)).send
        self._send("Performance.enable", {"timeDomain": "threadTicks"})

    def busy_s(self) -> float:
        """Return the CPU time that the main thread of the page has spent on tasks."""
        found: list[dict[str, Any]] = self._send("Performance.getMetrics")["metrics"]
        return next(float(each["value"]) for each in found if each["name"] == "TaskDuration")

    def heap_mb(self) -> float:
        """Return what is in use after a look for garbage."""
        self._send("HeapProfiler.collectGarbage")
        return float(self._send("Runtime.getHeapUsage")["usedSize"]) / 1e6


@contextmanager
def served(states: int) -> Generator[str]:
    """Run `flexcell serve` with a large behavior; gives the log-in address."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "behaviors").mkdir()
        Path(folder, ID).write_text(large_document(states), encoding="utf-8")
        with served_dashboard(Path(folder), Path(folder, ".flexcell")) as login:
            yield login


def in_place(page: Page) -> None:
    """Wait until the editor has drawn the document."""
    expect(page.locator(".react-flow[data-in-place] .react-flow__node").first).to_be_visible(timeout=_LIMIT_MS)
    expect(page.locator("[data-canvas]")).to_have_attribute("aria-busy", "false", timeout=_LIMIT_MS)


_OPENED = """() => new Promise((resolve) => {
    const look = () => document.querySelector('.react-flow[data-in-place] .react-flow__node')
        ? requestAnimationFrame(() => setTimeout(() => resolve(performance.now())))
        : requestAnimationFrame(look)
    look()
})"""


def opening(trial: Trial, page: Page) -> None:
    """From the navigation until the nodes are painted, with the page's files in the browser's cache after the first."""
    times: list[float] = []
    for _ in range(trial.rounds + 1):
        page.goto("about:blank")
        page.goto(f"{trial.url}/edit/{ID}", wait_until="commit")
        times.append(page.evaluate(_OPENED))
        in_place(page)
    trial.add("open collapsed, whole page, first time", times[0], "ms")
    trial.add("open collapsed, whole page", statistics.median(times[1:]), "ms", 600)
    inside: list[float] = []
    for _ in range(trial.rounds):
        page.goto(f"{trial.url}/")
        page.wait_for_load_state("networkidle")
        waited = page.evaluate(
            f"""async (path) => {{
                const begun = performance.now()
                history.pushState(null, '', path); dispatchEvent(new PopStateEvent('popstate'))
                return (await ({_OPENED})()) - begun
            }}""",
            f"/edit/{ID}",
        )
        inside.append(waited)
        in_place(page)
    trial.add("open collapsed, page already there", statistics.median(inside), "ms", 600)


def follow(trial: Trial, page: Page, words: str, bar: float, selector: str, at: list[float] | None) -> None:
    """Move what is at a place with the mouse: frames a second, and what a frame costs the page's main thread."""
    page.locator(selector).first.wait_for(timeout=_LIMIT_MS)
    devtools = Devtools(page)
    before = devtools.busy_s()
    done: dict[str, float] = page.evaluate("(a) => probe.drag(a[0], a[1], a[2])", [selector, at, _DRAG_S])
    spent_ms = (devtools.busy_s() - before) * 1e3 / done["frames"]
    trial.add(words, done["fps"], "fps", bar, least=True)
    trial.add(f"{words}: main thread", spent_ms, "ms CPU a frame")


def moving(trial: Trial, page: Page, words: str, bar: float, node: str, *, what: str = "a node") -> None:
    """Frames a second while the canvas and a node follow the mouse."""
    drawn = page.locator(".react-flow__node").count()
    trial.add(f"{words}: elements drawn as nodes", drawn, "")
    pane = page.locator(".react-flow__pane").bounding_box()
    assert pane is not None
    corner = [pane["x"] + pane["width"] * 0.5, pane["y"] + 8]
    follow(trial, page, f"{words}: panning", bar, ".react-flow__pane", corner)
    follow(trial, page, f"{words}: dragging {what}", bar, f".react-flow__node[data-id='{node}']", None)
    idle(page)
    page.keyboard.press("Control+z")
    idle(page)


def choose(page: Page, node: str) -> None:
    """Choose a node by a click at its head."""
    page.locator(f".react-flow__node[data-id='{node}']").dispatch_event("click")
    expect(page.locator(f".react-flow__node[data-id='{node}'].selected")).to_have_count(1, timeout=_LIMIT_MS)


def editing(trial: Trial, page: Page, words: str, node: str) -> None:
    """Duplicate a node and take it back: from the key until it is painted."""
    times: list[float] = []
    server: list[float] = []
    for _ in range(trial.rounds):
        choose(page, node)
        page.evaluate("() => { performance.clearResourceTimings() }")
        page.evaluate(
            """(path) => { probe.waited = probe.until('keydown', () =>
                document.querySelector(`.react-flow__node[data-id='${path}']`)) }""",
            f"{node}_2",
        )
        page.keyboard.press("Control+d")
        times.append(page.evaluate("() => probe.waited"))
        idle(page)
        server.append(
            page.evaluate(
                """() => { const all = performance.getEntriesByType('resource').filter((e) => e.name.endsWith('/edits'))
                    return all[0].responseEnd - all[0].requestStart }"""
            )
        )
        page.keyboard.press("Control+z")
        expect(page.locator(f".react-flow__node[data-id='{node}_2']")).to_have_count(0, timeout=_LIMIT_MS)
        idle(page)
    trial.add(f"{words}: an edit, key to paint", statistics.median(times), "ms", None if words == "overview" else 100)
    trial.add(f"{words}: an edit, answer of the server", statistics.median(server), "ms", 100)


def idle(page: Page) -> None:
    """Wait until the server has answered and the canvas shows it."""
    expect(page.locator("[data-editor]")).to_have_attribute("aria-busy", "false", timeout=_LIMIT_MS)
    expect(page.locator("[data-canvas]")).to_have_attribute("aria-busy", "false", timeout=_LIMIT_MS)


def open_all(page: Page) -> None:
    """Open every container inside of what fills the canvas."""
    page.locator(".react-flow__node").first.focus()
    page.keyboard.press("Shift+O")


def overview(trial: Trial, page: Page) -> None:
    """Open everything: how long the layout takes, and for how long the page does not answer meanwhile."""
    page.evaluate(
        "() => { const drawn = () => document.getElementsByClassName('react-flow__node').length\n"
        "probe.waited = probe.until('keydown', () => drawn() >= 1000) }"
    )
    start_recording(trial.browser, page)
    open_all(page)
    trial.add("open overview, key to paint of all", page.evaluate("() => probe.waited"), "ms")
    idle(page)
    recording = stop_recording(trial.browser, measure="flexcell:layout")
    trial.add("layout of all, in the worker", sum(end - begin for begin, end in recording.measured) / 1e3, "ms", 2000)
    for when, tasks, bar in (("it is laid out", recording.during(), 70), ("all is drawn", recording.tasks, None)):
        longest = max(tasks, key=lambda task: task.wall_ms)
        trial.add(f"longest task until {when}", longest.wall_ms, "ms", bar)
        trial.add(f"most CPU of a task until {when}", max(task.cpu_ms for task in tasks), "ms CPU")


def typing(trial: Trial, page: Page) -> None:
    """Type into the text: from each key to the frame that shows it."""
    page.keyboard.press("y")
    content = page.locator(".cm-content")
    expect(content).to_be_visible(timeout=_LIMIT_MS)
    content.click()
    page.keyboard.press("Control+Home")
    page.keyboard.press("Control+End")
    page.wait_for_timeout(300)
    page.evaluate("() => { probe.keys.length = 0; probe.tasks.length = 0 }")
    page.keyboard.type("# a comment of some length at the end of it all, typed by hand\n", delay=45)
    page.wait_for_timeout(1500)
    idle(page)
    keys: list[float] = page.evaluate("() => probe.keys")
    tasks: list[list[float]] = page.evaluate("() => probe.tasks")
    trial.add("typing in the text: key to paint, median", statistics.median(keys), "ms")
    trial.add("typing in the text: key to paint, longest", max(keys), "ms")
    trial.add("typing in the text: longest task", max((length for _, length in tasks), default=0.0), "ms")
    page.keyboard.press("Escape")
    page.locator(".react-flow__pane").click(position={"x": 5, "y": 5})
    page.keyboard.press("Control+z")
    idle(page)
    page.keyboard.press("y")


def live(trial: Trial, page: Page) -> None:
    """Open the run page, and let twenty nodes change again and again."""
    page.goto("about:blank")
    page.goto(f"{trial.url}/behaviors/{ID}", wait_until="commit")
    page.locator("[data-graph] .react-flow__node").first.wait_for(timeout=_LIMIT_MS)
    trial.add("run page: open until drawn", page.evaluate("() => performance.now()"), "ms")
    page.wait_for_timeout(1000)
    graph: Any = page.evaluate(f"async () => (await (await fetch('/api/v1/behaviors/{ID}')).json()).graph")
    spent: list[float] = page.evaluate("(paths) => probe.overlay(paths, 40)", _leaf_paths(graph))
    trial.add("run page: 20 changes, script", statistics.median(spent[5:]), "ms", 5)
    pane = page.locator("[data-graph]").bounding_box()
    assert pane is not None
    corner = [pane["x"] + pane["width"] / 2, pane["y"] + 8]
    follow(trial, page, "run page: panning, all in view", 20, "[data-graph] .react-flow__pane", corner)


def _leaf_paths(graph: Any) -> list[str]:
    inside = [path for child in graph["children"] for path in _leaf_paths(child)]
    return inside or [graph["path"]]


def heap(trial: Trial, page: Page, node: str) -> None:
    """Edit, undo and look around for a while: what the page's memory has grown by."""
    devtools = Devtools(page)
    trial.add("heap of the page before use", devtools.heap_mb(), "MB")
    edits = 0
    ends = page.evaluate("() => performance.now()") + trial.use_s * 1000
    while page.evaluate("() => performance.now()") < ends:
        choose(page, node)
        page.keyboard.press("Control+d")
        expect(page.locator(f".react-flow__node[data-id='{node}_2']")).to_have_count(1, timeout=_LIMIT_MS)
        idle(page)
        page.keyboard.press("Control+z")
        expect(page.locator(f".react-flow__node[data-id='{node}_2']")).to_have_count(0, timeout=_LIMIT_MS)
        idle(page)
        edits += 1
    trial.add(f"heap after {trial.use_s:.0f} s and {edits} edits taken back", devtools.heap_mb(), "MB")


def first_paint() -> float:
    """Return the size of the JavaScript that the first page loads, packed, in kB."""
    index = (STATIC / "index.html").read_text(encoding="utf-8")
    files = set(re.findall(r"(?:src|href)=\"/([^\"]+\.js)\"", index))
    return sum(len(gzip.compress((STATIC / file).read_bytes())) for file in files) / 1e3


def table(figures: list[Figure]) -> str:
    """Return the figures beside their bars."""
    lines = ["| figure | measured | bar | |", "|---|---|---|---|"]
    for each in figures:
        digits = 0 if each.value >= 100 or each.unit == "" else 1
        bar = "" if each.bar is None else f"{'≥' if each.least else '≤'} {each.bar:.0f} {each.unit}"
        mark = "" if each.bar is None else "holds" if each.holds else "MISSED"
        lines.append(f"| {each.name} | {each.value:.{digits}f} {each.unit} | {bar} | {mark} |")
    return "\n".join(lines)


def measure(trial: Trial, *, only: str = "") -> None:
    """Fill a trial."""
    context = trial.browser.new_context(locale="en-US", viewport={"width": 1280, "height": 800})
    context.add_init_script(PROBE)
    page = context.new_page()
    page.goto(trial.login)
    inner = "root/area_1/step_0"
    if not only or "open" in only:
        opening(trial, page)
    page.goto(f"{trial.url}/edit/{ID}")
    in_place(page)
    if not only or "work" in only:
        moving(trial, page, "collapsed", 50, "root/area_1")
        page.goto("about:blank")
        page.goto(f"{trial.url}/edit/{ID}#{inner}/wait_3")
        in_place(page)
        moving(trial, page, "a container of 10", 50, f"{inner}/wait_3")
        editing(trial, page, "a container of 10", f"{inner}/wait_3")
        page.goto("about:blank")
        page.goto(f"{trial.url}/edit/{ID}#{inner}")
        in_place(page)
        open_all(page)
        page.locator(f".react-flow__node[data-id='{inner}/wait_3']").wait_for(timeout=_LIMIT_MS)
        idle(page)
        moving(trial, page, "an area, all open", 50, "root/area_1/step_1", what="an open container")
        page.goto("about:blank")
        page.goto(f"{trial.url}/edit/{ID}")
        in_place(page)
        editing(trial, page, "collapsed", "root/area_1")
        typing(trial, page)
    if not only or "over" in only:
        overview(trial, page)
        moving(trial, page, "overview", 20, "root/area_1")
        editing(trial, page, "overview", "root/area_1/step_0/wait_3")
    if not only or "live" in only:
        live(trial, page)
    if trial.use_s > 0 and (not only or "use" in only):
        page.goto(f"{trial.url}/edit/{ID}")
        in_place(page)
        heap(trial, page, "root/area_1")
    trial.add("JavaScript of the first page, packed", first_paint(), "kB", 250)
    context.close()


def main() -> None:
    """Measure all, print the table, and end with 1 where a bar is missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--states", type=int, default=1000)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--use-s", type=float, default=120.0, help="how long the page is used for its memory")
    parser.add_argument("--only", default="", help="some of: open work over live use")
    options = parser.parse_args()
    program = os.environ.get("FLEXCELL_CHROMIUM") or next(filter(None, map(shutil.which, _BROWSERS)), None)
    load = os.getloadavg()[0]
    with served(options.states) as login, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        trial = Trial(browser, login, options.rounds, options.use_s)
        try:
            measure(trial, only=options.only)
        finally:
            print(f"\n{options.states} states, {platform.machine()}, {os.cpu_count()} cores, load {load:.1f} before")
            print(table(trial.figures))
        browser.close()
    raise SystemExit(0 if all(each.holds for each in trial.figures) else 1)


if __name__ == "__main__":
    main()
