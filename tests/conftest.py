"""Runs `async def` tests on a real or virtual event loop, fails a test that leaks a task, and chooses what is run."""

from __future__ import annotations

import argparse
import asyncio
import gc
import inspect
import logging
import os
import sys
from collections.abc import Generator
from pathlib import Path
from types import FunctionType
from typing import Any, cast

import pytest
from hypothesis import settings

from engine.clock import run_virtual
from tests.cpu_times import CpuTimes
from tests.tiers import SECOND_TRY, ThisRun, examples, kinds_of
from tests.turns import Turn, defined_tests, takes_turns

# Events of the interpreter when a process is started.
PROCESS_EVENTS = frozenset({"subprocess.Popen", "os.fork", "os.forkpty", "os.posix_spawn", "os.system"})
# hypothesis asks every module for its file. That loads the `glfw` which `mujoco_library` has put off, and `glfw` has a
# process tell it the version of its library.
GLFW_VERSION = "def get_version(library_handle)"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add what chooses how much is run."""
    parser.addoption("--cpu", action="store_true", help="print where the processor time went, by stage and room")
    parser.addoption("--nightly", action="store_true", help="more of the same: values marked `nightly`, examples")
    parser.addoption(
        "--turn", type=_turn, metavar="K/N", help="of what needs a browser, process or physics, the Kth of N shares"
    )


def pytest_configure(config: pytest.Config) -> None:
    """Name the markers; a fast run lets no test start a process, a browser among them."""
    for line in (
        "fast: has none of the next three; a run of these alone (`-m fast`) does not even read the others",
        "virtual: run this async test on a virtual event loop",
        "browser: drives a real browser (set by what the file imports, see tests/tiers.py)",
        "process: starts processes (set by what the file imports)",
        "physics: steps a simulated world (set by what the file imports)",
        "jumps: its set points may jump: it is about that",
        "nightly: more of what other values show already; run with --nightly",
    ):
        config.addinivalue_line("markers", line)
    if config.getoption("--cpu"):
        config.pluginmanager.register(CpuTimes())
    ThisRun.nightly = bool(config.getoption("--nightly"))
    # How long an example takes depends on what else the machine does: only the time-out of the whole test counts.
    settings.register_profile("flexcell", deadline=None, max_examples=examples(50, nightly=300))
    settings.load_profile("flexcell")
    if _is_fast(config):
        sys.addaudithook(_refuse_process)


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Leave out files with a marker in a fast run, or without a test in a turn, unread: what they import takes long."""
    if collection_path.suffix != ".py" or not collection_path.name.startswith("test_"):
        return None
    turn: Turn | None = config.getoption("--turn")
    is_for_others = turn is not None and not turn.has_any_of(collection_path)
    return True if is_for_others or (_is_fast(config) and kinds_of(collection_path)) else None


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark tests by what they need, and leave out those for the night; each must be one that turns know of."""
    require_known_to_turns(items)
    for item in items:
        for kind in sorted(kinds_of(item.path)) or ("fast",):
            item.add_marker(getattr(pytest.mark, kind))
        if isinstance(item, pytest.Function) and "browser" in item.fixturenames:
            item.add_marker(SECOND_TRY)
    left_out = [item for item in items if _is_left_out(item, config)]
    config.hook.pytest_deselected(items=left_out)
    items[:] = [item for item in items if item not in left_out]


@pytest.hookimpl(wrapper=True, tryfirst=True, specname="pytest_collection_modifyitems")
def pytest_house_first(items: list[pytest.Item]) -> Generator[None, object, object]:
    """Have one process test the house, whatever order was drawn: it reads every source, once for all of its tests."""
    result = yield
    items.sort(key=lambda item: not item.nodeid.startswith("tests/house/"))
    return result


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Have no garbage collected while tests are read: nearly all that is made stays."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.enable()


def pytest_collection_finish() -> None:
    """Have the garbage collector pass by what was imported, which stays; a tenth of the time goes into that."""
    gc.collect()
    gc.freeze()


def require_known_to_turns(items: list[pytest.Item]) -> None:
    """Refuse a costly test that `tests/turns.py` does not see in the text of its file: no turn would have it."""
    files = {item.path for item in items if item.path.suffix == ".py" and takes_turns(item.path)}
    known = {file: defined_tests(file) for file in files}
    for item in items:
        if item.path in known and item.nodeid.partition("[")[0] not in known[item.path]:
            problem = f"{item.nodeid} is not defined in its file, so that no turn would have it"
            raise pytest.UsageError(f"{problem}: define it there (tests/turns.py)")


def _is_left_out(item: pytest.Item, config: pytest.Config) -> bool:
    is_more = item.get_closest_marker("nightly") is not None or _is_in_the_dark(item)
    if is_more and not config.getoption("--nightly"):
        return True
    turn: Turn | None = config.getoption("--turn")
    return turn is not None and not turn.has(item.nodeid, item.path)


def _turn(text: str) -> Turn:
    try:
        return Turn.parse(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _is_in_the_dark(item: pytest.Item) -> bool:
    """Whether a test does in the dark theme what it does in the light one, and there looks at both."""
    if not isinstance(item, pytest.Function) or "dark" not in _values(item):
        return False
    return "require_accessible" in cast("FunctionType", item.obj).__code__.co_names


def _refuse_process(event: str, arguments: tuple[Any, ...]) -> None:
    # Set while a test runs; pytest itself starts its worker processes.
    if event in PROCESS_EVENTS and "PYTEST_CURRENT_TEST" in os.environ and GLFW_VERSION not in str(arguments):
        raise AssertionError(f"a fast test starts a process ({event} {arguments[:1]}): see tests/tiers.py")


def _is_fast(config: pytest.Config) -> bool:
    return config.getoption("-m") == "fast"


def _values(item: pytest.Function) -> list[str]:
    """The texts among the values that a test is called with."""
    values = item.callspec.params.values() if hasattr(item, "callspec") else ()
    return [each for each in values if isinstance(each, str)]


@pytest.fixture(autouse=True)
def _set_points_never_jump(request: pytest.FixtureRequest) -> Generator[None]:  # pyright: ignore[reportUnusedFunction]
    """Fail a test in which a set point of an arm jumps; a test about jumps is marked `jumps`."""
    reports = JumpReports()
    log = logging.getLogger("flexcell.set_points")
    log.addHandler(reports)
    try:
        yield
    finally:
        log.removeHandler(reports)
    if request.node.get_closest_marker("jumps") is None:
        assert not reports.reasons, "\n".join(reports.reasons)


class JumpReports(logging.Handler):
    """Collects what the watches of set points report."""

    def __init__(self) -> None:
        super().__init__()
        self.reasons: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        """Take a report."""
        self.reasons.append(record.getMessage())


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
