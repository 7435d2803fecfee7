"""A tool changer whose world is in a process of its own: a tool that comes off is published without a question."""

from __future__ import annotations

import asyncio
from pathlib import Path

from engine.skills.device_moves import DeviceFault
from engine.skills.tool_changer import LockToolResult, ReleaseToolResult, ToolChangerState
from tests.robots.tool_changer.test_tool_changer_server import break_it, lock, opened, release, settings, state


async def test_a_tool_that_comes_off_is_published(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        bus = cell.bus
        assert await lock(bus) == LockToolResult(ended="locked")
        assert (state(bus).tool, await settings(bus)) == ("probe", (0.1, 0.4, 0.0225))
        messages = bus.topic("arm/tool_changer", ToolChangerState).stream()
        await break_it(bus, DeviceFault(air=False))
        async with asyncio.timeout(20.0):
            while (await messages.next()).problem != "probe came off":
                pass
        assert await settings(bus) == (0.0, 0.0, 0.0)
        await break_it(bus, DeviceFault())
        assert await release(bus) == ReleaseToolResult(ended="released")
        assert (state(bus).lock, state(bus).problem) == ("open", "")
