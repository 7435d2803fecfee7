"""Makes the pictures in docs/screenshots: serves the demo cell, runs the transfer, photographs the page in mid-motion.

    python docs/make_screenshots.py

Needs the extras `all` and `test` and a Chromium. Without a graphics card the 3D view takes seconds a picture.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Literal

from playwright.sync_api import Browser, Page, expect, sync_playwright

ROOT = Path(__file__).parent.parent
OUT = ROOT / "docs" / "screenshots"
CELL = ROOT / "behaviors" / "cells" / "dual_panda.yaml"
BEHAVIOR = "behaviors/reconcycle/two_arm_transfer.yaml"
LOGIN = re.compile(r"http://\S+/login\?t=\S+")
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
PICTURE_LIMIT_MS = 120_000
Scheme = Literal["light", "dark"]


@contextmanager
def served() -> Generator[str]:
    """Run `flexcell serve` on a free port; gives the log-in address."""
    program = Path(sys.executable).with_name("flexcell")
    with tempfile.TemporaryDirectory() as state:
        command = [program, "serve", "--cell", CELL, "--port", "0", "--project", ROOT, "--state", state]
        server = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)
        try:
            assert server.stdout is not None
            found = next((match for line in server.stdout if (match := LOGIN.search(line))), None)
            if found is None:
                raise SystemExit("flexcell serve ended without printing its address")
            yield found.group()
        finally:
            server.terminate()
            server.wait(timeout=60)


def picture(page: Page, name: str) -> None:
    """Take one picture."""
    OUT.mkdir(parents=True, exist_ok=True)
    file = OUT / f"{name}.png"
    page.screenshot(path=file, timeout=PICTURE_LIMIT_MS)
    print(file.relative_to(ROOT))


def visit(browser: Browser, login: str, scheme: Scheme) -> Page:
    """Open the page of the transfer, logged in, with the 3D view drawn."""
    page = browser.new_page(locale="en-US", color_scheme=scheme, viewport={"width": 1600, "height": 900})
    page.goto(login)
    page.goto(login.partition("/login")[0] + f"/behaviors/{BEHAVIOR}")
    drawn = page.frame_locator("iframe[title='3D view of the cell']").locator("canvas[data-engine]")
    expect(drawn).to_be_visible(timeout=PICTURE_LIMIT_MS)
    expect(page.locator(".leaf").first).to_be_visible()
    return page


def in_motion(page: Page, name: str) -> None:
    """Start the transfer, take a picture while both arms move, wait for its end, put the parts back."""
    page.get_by_role("button", name="Start").click()
    expect(page.locator(".leaf.is-active")).to_have_count(2, timeout=60_000)
    expect(page.get_by_role("log")).to_contain_text("ended with reached", timeout=60_000)
    picture(page, name)
    expect(page.locator(".page-head .badge")).not_to_have_text("running", timeout=120_000)
    page.get_by_role("button", name="Reset parts").click(timeout=PICTURE_LIMIT_MS)
    expect(page.get_by_text("Parts are back")).to_be_visible(timeout=60_000)


def main() -> None:
    """Make all pictures."""
    program = os.environ.get("FLEXCELL_CHROMIUM") or next(filter(None, map(shutil.which, BROWSERS)), None)
    with served() as login, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        schemes: tuple[Scheme, ...] = ("light", "dark")
        for scheme in schemes:
            page = visit(browser, login, scheme)
            in_motion(page, f"dashboard-{scheme}")
            page.goto(login.partition("/login")[0] + "/")
            expect(page.get_by_role("table")).to_be_visible()
            page.wait_for_timeout(4000)
            picture(page, f"cell-{scheme}")
            page.close()
        browser.close()


if __name__ == "__main__":
    main()
