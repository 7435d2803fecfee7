"""Makes the pictures in docs/screenshots: serves the demo cells and photographs the page at work, in both themes.

    python docs/make_screenshots.py [--out FOLDER] [NAME …]

`dashboard` is the two-arm transfer in mid-motion, `cell` and `phone` the cell at rest, `confirm` and `confirm-phone`
a planned path that waits for its operator, `shared` an arm that waits because a person reaches into its path,
`editor` a behavior in the editor, `timeline` a moment of a run that is over, `teach` the page that teaches,
`workcell` the page of the cell, `sweep` what the first runs of a sweep have shown, which are executed before.

Only where they are named: `operate`, `debug` and `3d` are the layouts of a paused run, each at three sizes. They
are not kept in the repository; give a folder for them. Needs the extras `all` and `test` and a Chromium. Without a
graphics card the 3D view takes seconds a picture; it is waited for until two shots in a row are equal.
"""

from __future__ import annotations

import argparse
import io
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from PIL import Image
from playwright.sync_api import Browser, Page, expect, sync_playwright

from benchmarks.served_dashboard import served_dashboard
from tests.editor_web.browsing import browser_program

ROOT = Path(__file__).parent.parent
OUT = ROOT / "docs" / "screenshots"
LIMIT_MS = 240_000
STILL_LIMIT_S = 180.0
"""Within which the 3D view must come to rest; without a graphics card it draws for seconds."""
BETWEEN_SHOTS_MS = 3000
"""Between two shots of the 3D view, so that what is on its way arrives: meshes come one by one after the canvas."""
FEWEST_COLOURS = 200
"""A 3D view with fewer has drawn only its ground so far."""
VIEW = "iframe[title='3D view of the cell']"
Scheme = Literal["light", "dark"]
Size = tuple[int, int]
DESKTOP: Size = (1280, 800)
LARGE: Size = (1920, 1080)
PHONE: Size = (390, 844)


@dataclass(frozen=True, kw_only=True)
class Picture:
    """One picture: what is served, which address is opened at which size, and what is done before it is taken."""

    name: str
    cell: str | None
    """None where the page is served without one."""
    address: str
    size: Size
    prepare: Callable[[Page], None]
    before: Callable[[], None] = lambda: None
    """What is done before it is served."""
    further: tuple[Size, ...] = ()
    """Other sizes of the window in which the same moment is photographed."""


@contextmanager
def served(cell: str | None) -> Generator[str]:
    """Run `flexcell serve` on a free port; gives the log-in address."""
    file = None if cell is None else ROOT / "behaviors" / "cells" / f"{cell}.yaml"
    with tempfile.TemporaryDirectory() as state, served_dashboard(ROOT, Path(state), cell=file) as login:
        yield login


def sweep_runs() -> None:
    """Execute the first runs of the sweep of the pick and place; those that are saved are not executed again."""
    program = Path(sys.executable).with_name("flexcell")
    command = [program, "sweep", ROOT / SWEEP, "--runs", str(SWEEP_RUNS), "--quiet"]
    # The exit code is the verdict.
    subprocess.run(command, cwd=ROOT, check=False, stdout=subprocess.DEVNULL)


def still(page: Page) -> None:
    """Wait until two shots of the 3D view in a row are equal, and show something; the arms must be at rest.

    Nothing on the page tells when the last mesh is drawn, nor when another size is.

    Raises:
        TimeoutError: It has not come to rest within the limit.
    """
    view = page.locator(VIEW)
    end_s = time.monotonic() + STILL_LIMIT_S
    before, shots, colours = b"", 0, 0
    while time.monotonic() < end_s:
        now = view.screenshot(timeout=LIMIT_MS)
        shots += 1
        if now == before:
            colours = len(Image.open(io.BytesIO(now)).convert("RGB").getcolors(1 << 24) or ())
            if colours >= FEWEST_COLOURS:
                return
        before = now
        page.wait_for_timeout(BETWEEN_SHOTS_MS)
    seen = f"it shows {colours} colours only, no cell" if colours else "no two in a row were equal"
    raise TimeoutError(
        f"the 3D view of {page.url} is not at rest after {STILL_LIMIT_S:g} s and {shots} shots: {seen}; "
        "see whether something moves there, and raise STILL_LIMIT_S on a slow machine"
    )


def drawn(page: Page) -> None:
    """Wait until the 3D view has drawn the cell at rest."""
    view = page.frame_locator(VIEW).locator("canvas[data-engine]")
    expect(view).to_be_visible(timeout=LIMIT_MS)
    still(page)


def start(page: Page) -> None:
    """Press the button."""
    page.get_by_role("button", name="Start", exact=True).click()


def in_motion(page: Page) -> None:
    """Start the transfer and wait until both arms move."""
    drawn(page)
    start(page)
    expect(page.locator('[data-node="leaf"][data-status="active"]')).to_have_count(2, timeout=LIMIT_MS)
    page.get_by_role("tab", name="Log").click()
    expect(page.get_by_role("log")).to_contain_text("ended with reached", timeout=LIMIT_MS)


def paused(page: Page) -> None:
    """Start the transfer in whatever layout the page has, and pause it in mid-motion."""
    drawn(page)
    start(page)
    state = page.get_by_role("status", name="State of the run")
    expect(state).to_have_text("Running", timeout=LIMIT_MS)
    # A click would wait until the button rests for two frames, which may be longer than the run.
    page.get_by_role("button", name="Pause", exact=True).dispatch_event("click")
    expect(state).to_contain_text("Paused", timeout=LIMIT_MS)


def asked(page: Page) -> None:
    """Start below full autonomy, and wait for the question about the planned path."""
    is_narrow = page.viewport_size is not None and page.viewport_size["width"] < DESKTOP[0]
    if not is_narrow:
        drawn(page)
    page.get_by_role("button", name="Operation").click()
    page.get_by_role("combobox", name="Autonomy at the start").click()
    page.get_by_role("option", name="low").click()
    start(page)
    expect(page.get_by_role("region", name="The run asks")).to_contain_text("shown in the 3D view", timeout=LIMIT_MS)
    if is_narrow:
        page.get_by_role("tab", name="Cell").click()
        drawn(page)


def waiting(page: Page) -> None:
    """Let a person keep a hand in the way, and wait until the arm says that it waits."""
    drawn(page)
    page.get_by_role("combobox", name="person", exact=True).click()
    page.get_by_role("option", name="stays").click()
    start(page)
    page.get_by_role("tab", name="Log").click()
    expect(page.get_by_role("log")).to_contain_text("pick —picked→ carry", timeout=LIMIT_MS)
    expect(page.get_by_role("list", name="Arms with a blocked path")).to_be_visible(timeout=LIMIT_MS)


def edited(page: Page) -> None:
    """All of it on the canvas, with one state chosen by the address."""
    expect(page.locator(".react-flow[data-in-place] .react-flow__node").first).to_be_visible(timeout=LIMIT_MS)
    expect(page.locator("[data-card][data-selected]").first).to_be_visible(timeout=LIMIT_MS)
    expect(page.get_by_role("button", name="Add gripper.Grasp", exact=True)).to_be_attached(timeout=LIMIT_MS)


def looked_back(page: Page) -> None:
    """Let the transfer end, and go back to where both arms carry their parts."""
    drawn(page)
    start(page)
    expect(page.get_by_role("status", name="State of the run")).to_have_text("Succeeded", timeout=LIMIT_MS)
    page.get_by_role("tab", name="Timeline").click()
    ruler = page.get_by_role("slider", name="Moment of the run")
    expect(ruler).to_be_visible(timeout=LIMIT_MS)
    box = ruler.bounding_box()
    assert box is not None
    page.mouse.click(box["x"] + 0.45 * box["width"], box["y"] + 8)
    expect(page.get_by_role("button", name="Back to live")).to_be_visible(timeout=LIMIT_MS)
    still(page)


def taught(page: Page) -> None:
    """Beside the arm."""
    drawn(page)


def swept(page: Page) -> None:
    """As it opens."""
    expect(page.get_by_role("img", name="Success rate after each")).to_be_visible(timeout=LIMIT_MS)


SWEEP = "behaviors/sweeps/pick_and_place.yaml"
SWEEP_RUNS = 40
CONFIRM = "/behaviors/behaviors/pick_and_place/confirmed_move.yaml"
TRANSFER = "/behaviors/behaviors/reconcycle/two_arm_transfer.yaml"
EDITOR = "/edit/behaviors/reconcycle/two_arm_transfer.yaml#root/transfer/left/grasp"
SHARED = "/behaviors/behaviors/plate_transfer_shared/plate_transfer_shared.yaml"
PICTURES = (
    Picture(name="dashboard", cell="dual_panda", address=TRANSFER, size=DESKTOP, prepare=in_motion),
    Picture(name="cell", cell="dual_panda", address="/", size=LARGE, prepare=drawn),
    Picture(name="phone", cell="dual_panda", address="/", size=PHONE, prepare=drawn),
    Picture(name="confirm", cell="ur10", address=CONFIRM, size=DESKTOP, prepare=asked),
    Picture(name="confirm-phone", cell="ur10", address=CONFIRM, size=PHONE, prepare=asked),
    Picture(name="editor", cell="dual_panda", address=EDITOR, size=LARGE, prepare=edited),
    Picture(name="timeline", cell="dual_panda", address=TRANSFER + "?layout=debug", size=DESKTOP, prepare=looked_back),
    Picture(name="teach", cell="dual_panda", address="/teach", size=DESKTOP, prepare=taught),
    Picture(name="workcell", cell="dual_panda", address="/workcell/robots/left", size=DESKTOP, prepare=drawn),
    Picture(name="shared", cell="irb4600_shared", address=SHARED, size=DESKTOP, prepare=waiting),
    Picture(name="sweep", cell=None, address=f"/sweeps/{SWEEP}", size=LARGE, prepare=swept, before=sweep_runs),
)
LAYOUTS = tuple(
    Picture(
        name=name,
        cell="dual_panda",
        address=f"{TRANSFER}?layout={name}",
        size=DESKTOP,
        prepare=paused,
        further=(LARGE, PHONE),
    )
    for name in ("operate", "debug", "3d")
)


def take(browser: Browser, login: str, picture: Picture, scheme: Scheme, out: Path) -> None:
    """Open the page, logged in, bring it to where it is worth a picture, and take that."""
    width, height = picture.size
    page = browser.new_page(locale="en-US", color_scheme=scheme, viewport={"width": width, "height": height})
    page.set_default_timeout(LIMIT_MS)
    page.goto(login)
    page.goto(login.partition("/login")[0] + picture.address)
    picture.prepare(page)
    out.mkdir(parents=True, exist_ok=True)
    for size in (picture.size, *picture.further):
        if size != picture.size:
            page.set_viewport_size({"width": size[0], "height": size[1]})
            still(page)
        at = f"-{size[0]}x{size[1]}" if picture.further else ""
        file = out / f"{picture.name}{at}-{scheme}.png"
        page.screenshot(path=file, timeout=LIMIT_MS)
        print(file, flush=True)
    page.close()


def main() -> None:
    """Make the pictures that are named, or all."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(p.name for p in (*PICTURES, *LAYOUTS)))
    parser.add_argument("--out", type=Path, default=OUT, help="the folder for the pictures; default docs/screenshots")
    options = parser.parse_args()
    chosen = [each for each in (*PICTURES, *LAYOUTS) if each.name in options.names] if options.names else PICTURES
    schemes: tuple[Scheme, ...] = ("light", "dark")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=browser_program(), args=["--no-sandbox"])
        for picture in chosen:
            picture.before()
            for scheme in schemes:
                # A cell of its own for each: what one leaves behind is not in the next.
                with served(picture.cell) as login:
                    take(browser, login, picture, scheme, options.out)
        browser.close()


if __name__ == "__main__":
    main()
