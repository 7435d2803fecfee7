"""The benchmark of plugging measures what it says; the figures are not looked at."""

from __future__ import annotations

from benchmarks.plugging import measure, report


async def test_every_plug_is_timed_with_the_loop_beside_it() -> None:
    figures = await measure(2)
    assert (len(figures.plug_s), len(figures.unplug_s)) == (2, 2)
    assert figures.alone is not None
    assert figures.plugging is not None
    assert figures.plugging.steps > 0
    assert min(figures.memories_mb) > 10.0
    text = report(figures)
    assert "| plug, 2 times |" in text
    assert "| plugged and unplugged |" in text
