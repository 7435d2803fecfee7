"""What tasks at the page take in clicks, key presses and seconds: `python -m benchmarks.clicks [--before FOLDER]`.

Chromium operates `flexcell serve` with the cell of two Pandas in physics, at 1280 × 800. `--before` is a checkout
of an older version with its page built, whose server and behaviors are used: the same tasks are done there. Clicks and
keys do not depend on the machine; seconds are those of a script that reads nothing, and depend on everything. The 3D
view is left out: drawn without a graphics card it would be most of the time. Needs the extras `all` and `test` and a
Chromium.
"""

from __future__ import annotations

import argparse
import re
import shutil
import sys
import tempfile
import time
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from playwright.sync_api import Browser, Error, Page, expect, sync_playwright

from benchmarks.clicks_build import BUILD
from benchmarks.clicks_tasks import (
    DOCUMENTS,
    Hand,
    Task,
    approve,
    at_home,
    compare,
    failed,
    find_cause,
    holding,
    recover,
    teach,
    two_runs,
)
from benchmarks.served_dashboard import served_dashboard
from tests.editor_web.browsing import browser_program

ROOT = Path(__file__).parents[1]
TASKS = (
    Task(name="start and approve", prepare=at_home, do=approve),
    Task(name="find why a run failed", prepare=failed, do=find_cause),
    Task(name="recover after a stop with a part in the hand", prepare=holding, do=recover),
    BUILD,
    Task(name="teach and use a pose", prepare=at_home, do=teach),
    Task(name="compare two runs", prepare=two_runs, do=compare),
)
_LIMIT_MS = 120_000
_WORLD = "world: {kind: mujoco, step_s: 0.002, engine_silence_s: 5.0, world_silence_s: 5.0}"
"""A machine that draws pages beside the physics may be late."""


@dataclass(frozen=True, kw_only=True)
class Figure:
    """What a task took; `missing` is what the page does not do of it."""

    task: str
    clicks: int
    keys: int
    took_s: float
    missing: str


@contextmanager
def served(tree: Path) -> Generator[str]:
    """Run `flexcell serve` of a checkout on a project with the demo cell; gives the log-in address."""
    with tempfile.TemporaryDirectory() as folder:
        behaviors = Path(folder, "behaviors")
        for part in ("cells", "entries"):
            shutil.copytree(tree / "behaviors" / part, behaviors / part)
        cell = behaviors / "cells" / "dual_panda.yaml"
        cell.write_text(re.sub(r"(?m)^world: .*$", _WORLD, cell.read_text(encoding="utf-8")), encoding="utf-8")
        for name, text in DOCUMENTS.items():
            Path(folder, name).parent.mkdir(exist_ok=True)
            Path(folder, name).write_text(text, encoding="utf-8")
        with served_dashboard(Path(folder), Path(folder, ".flexcell"), cell=cell, tree=tree) as login:
            yield login


def new_page(browser: Browser, login: str) -> Page:
    """A page that is logged in, without the 3D view and without the invitation to the tour."""
    context = browser.new_context(locale="en-US", viewport={"width": 1280, "height": 800})
    context.set_default_timeout(_LIMIT_MS)
    context.route(re.compile(r"^http://[^/]+/cell/"), lambda route: route.abort())
    page = context.new_page()
    page.goto(login)
    return page


def done(page: Page, url: str, task: Task) -> Figure:
    """Do a task; one that ends early has its reason for a figure."""
    hand, missing = Hand(page, url), "it could not be prepared"
    started_s = time.perf_counter()
    try:
        task.prepare(Hand(page, url))
        missing, started_s = "", time.perf_counter()
        missing = task.do(hand)
    except (Error, AssertionError) as error:
        # A step that this version of the page does not have, or a machine that is too slow.
        missing = f"{missing or 'ended early'}: {str(error).splitlines()[0]}"
    return Figure(
        task=task.name, clicks=hand.clicks, keys=hand.keys, took_s=time.perf_counter() - started_s, missing=missing
    )


def table(figures: list[Figure]) -> str:
    """As in docs/benchmarks.md."""
    lines = ["| task | clicks | keys | s | what the page does not do |", "|---|--:|--:|--:|---|"]
    lines += [f"| {f.task} | {f.clicks} | {f.keys} | {f.took_s:.0f} | {f.missing} |" for f in figures]
    return "\n".join(lines)


def main() -> None:
    """Do all tasks, or those that are named, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--before", type=Path, default=ROOT, metavar="FOLDER", help="a checkout whose page is operated")
    parser.add_argument("--only", action="append", metavar="NAME", help="a part of the name of a task")
    arguments = parser.parse_args()
    chosen = [each for each in TASKS if not arguments.only or any(part in each.name for part in arguments.only)]
    expect.set_options(timeout=_LIMIT_MS)
    with sync_playwright() as playwright, served(arguments.before.resolve()) as login:
        browser = playwright.chromium.launch(executable_path=browser_program(), args=["--no-sandbox"])
        page = new_page(browser, login)
        figures: list[Figure] = []
        for task in chosen:
            figures.append(done(page, login.partition("/login")[0], task))
            print(figures[-1], file=sys.stderr, flush=True)
        browser.close()
    print(table(figures))


if __name__ == "__main__":
    main()
