"""A tool with a driver waits for a silent engine as long as its cell says, but not shorter than usual."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.cell.drivers import DeviceContext
from engine.document import load_cell
from robots.drivers.fresh_link import LinkTiming
from robots.drivers.tool_timing import tool_timing

CELL = """\
flexcell: 1
cell: bench
{world}robots:
  left: {{model: ur10, driver: {{kind: universal_robots, host: 127.0.0.1}}}}
"""
WORLD = "world: {{kind: mujoco, engine_silence_s: {silence_s}}}\n"


@pytest.mark.parametrize(("silence_s", "expected_s"), [(None, 0.3), (0.2, 0.3), (5.0, 5.0)])
def test_the_silence_of_the_engine_is_that_of_the_cell(
    tmp_path: Path, silence_s: float | None, expected_s: float
) -> None:
    file = tmp_path / "cell.yaml"
    world = WORLD.format(silence_s=silence_s) if silence_s is not None else ""
    file.write_text(CELL.format(world=world), encoding="utf-8")
    context = DeviceContext(cell=load_cell(file), robot="left")
    timing = tool_timing(context, period_s=0.02, stale_s=1.0)
    assert timing == LinkTiming(period_s=0.02, stale_s=1.0, silence_s=expected_s)
