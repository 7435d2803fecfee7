"""Runs `async def` tests on a real or virtual event loop and fails a test that leaks a task."""

from __future__ import annotations

import asyncio
import inspect
from typing import Any

import pytest
from hypothesis import settings

from engine.clock import run_virtual

# How long an example takes depends on what else the machine does: only the time-out of the whole test counts.
settings.register_profile("flexcell", deadline=None)
settings.load_profile("flexcell")


def pytest_configure(config: pytest.Config) -> None:
    """Name the marker that chooses the loop."""
    config.addinivalue_line("markers", "virtual: run this async test on a virtual event loop")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Give a second try to what runs against wall time; see docs/decisions/0020-second-try.md."""
    for item in items:
        if isinstance(item, pytest.Function) and _is_against_wall_time(item):
            item.add_marker(pytest.mark.flaky(reruns=1))


def _is_against_wall_time(item: pytest.Function) -> bool:
    arguments = item.callspec.params.values() if hasattr(item, "callspec") else ()
    return "browser" in item.fixturenames or any(isinstance(each, str) and each == "process" for each in arguments)


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> bool | None:
    """Run coroutine tests: on the virtual loop when marked so, else on a real one."""
    if not inspect.iscoroutinefunction(pyfuncitem.obj):
        return None
    names = inspect.signature(pyfuncitem.obj).parameters
    arguments: dict[str, Any] = {name: pyfuncitem.funcargs[name] for name in names if name in pyfuncitem.funcargs}
    test = _without_leaks(pyfuncitem.obj, arguments)
    if pyfuncitem.get_closest_marker("virtual"):
        run_virtual(test)
    else:
        asyncio.run(test)
    return True


async def _without_leaks(function: Any, arguments: dict[str, Any]) -> None:
    await function(**arguments)
    await asyncio.sleep(0)
    left = [t for t in asyncio.all_tasks() if t is not asyncio.current_task()]
    assert not left, f"the test left tasks running: {[t.get_name() for t in left]}"
