"""Runs documents written in a test in virtual time and tells what they have covered."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from pathlib import Path
from textwrap import dedent

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.coverage import CoverageCollector
from engine.document import Behavior, load_behavior, parse_behavior
from engine.event import Event
from engine.runtime.plan import Catalogue, new_plan
from engine.runtime.run import Run
from tests.engine.fake_states import CATALOGUE

HEAD = "flexcell: 1\nname: test\noutcomes: [good, bad]\nsuccess: [good]\n"


def behavior_of(text: str) -> Behavior:
    """Return the behavior of `root:` and what else a test writes."""
    return parse_behavior(HEAD + dedent(text), file="test.yaml")


def written(folder: Path, files: Mapping[str, str]) -> Behavior:
    """Write behaviors into a folder and return the first of them."""
    for name, text in files.items():
        (folder / name).write_text(HEAD + dedent(text), encoding="utf-8")
    return load_behavior(folder / next(iter(files)))


def events_of(
    behavior: Behavior,
    *,
    inputs: Mapping[str, object] | None = None,
    stop_at_s: float | None = None,
    catalogue: Catalogue = CATALOGUE,
) -> tuple[Event, ...]:
    """Run it and return its events."""
    events: list[Event] = []

    async def main() -> None:
        bus = SkillBus(new_clock())
        run = Run(new_plan(behavior, catalogue), run="r", bus=bus, inputs=inputs)
        run.watch(events.append)
        if stop_at_s is not None:
            asyncio.get_running_loop().call_later(stop_at_s, run.stop, "test")
        await run.execute()

    run_virtual(main())
    return tuple(events)


def covered(behavior: Behavior, *inputs: Mapping[str, object], stop_at_s: float | None = None) -> CoverageCollector:
    """Run it once for each of `inputs`, once at least, and return what that covered."""
    coverage = CoverageCollector(behavior, CATALOGUE)
    for given in inputs or ({},):
        coverage.add(events_of(behavior, inputs=given, stop_at_s=stop_at_s))
    return coverage


def seen(coverage: CoverageCollector) -> dict[str, int]:
    """Return what was seen, and how often, as `path: label`."""
    return {f"{item.path}: {item.label}": item.count for item in coverage.items if item.count}


def missing(coverage: CoverageCollector) -> list[str]:
    """Return what was not, as `path: label`."""
    return [f"{item.path}: {item.label}" for item in coverage.missing]
