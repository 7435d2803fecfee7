"""Which tests drive a browser, start processes or step physics, told from what their files import."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest
from _pytest.mark import ParameterSet

ROOT = Path(__file__).resolve().parents[1]
IMPORT = re.compile(r"^\s*(?:from|import) ([\w.]+)(?: import ([\w, ]+|\())?", re.MULTILINE)
KINDS = {
    "playwright": "browser",
    "subprocess": "process",
    "multiprocessing": "process",
    "engine.editing.targets.target_checks": "process",
    "robots.planning.worker.planning_worker": "process",
    "benchmarks": "process",
    "mujoco": "physics",
    "robots.sim": "physics",
    # Cells name their world; these open whatever is named.
    "engine.cell.open_cell": "physics",
    "engine.project.cell_runner": "physics",
    "engine.project.session": "physics",
    "engine.testing": "physics",
    "robots.simulated_cell": "physics",
}
FOLDERS = {
    "tests/behaviors": "physics",
    "tests/benchmarks": "process",
    "tests/replay": "physics",
    # They have an arm and a wall of their own, at 1 kHz.
    "tests/robots/control": "physics",
}
# They call what starts npm and other tools.
FILES = {
    "tests/editor_web/test_frontend.py": "process",
    # Scenes are written by a process of their own.
    "tests/engine/cell/test_scene_file.py": "process",
    # The libraries of the system are looked up by its tools.
    "tests/engine/doctor/test_host_machine.py": "process",
    # They execute sweeps by their workers.
    "tests/engine/sweep_library/test_search_view.py": "process",
    "tests/engine/sweep_library/test_sweep_reader.py": "process",
    "tests/house/test_audit.py": "process",
    # It asks git for the commit.
    "tests/house/test_turns.py": "process",
}


# In the words of Playwright.
BROWSER_DIED = r"Target crashed|Page crashed|[Bb]rowser has been closed|Connection closed while reading from the driver"
SECOND_TRY = pytest.mark.flaky(reruns=1, only_rerun=[BROWSER_DIED])
"""For tests that drive a browser: once more where the browser itself has died; docs/decisions/0020-second-try.md."""


def nightly(*values: object) -> ParameterSet:
    """Make a value of a parametrized test, or those of one row, one of those that only run with `--nightly`."""
    return pytest.param(*values, marks=pytest.mark.nightly)


class ThisRun:
    """What the options of pytest ask for; set before tests are read."""

    nightly = False


def examples(usual: int, *, nightly: int) -> int:
    """Return how many random examples a test takes, others in each run: `usual`, or `nightly` with `--nightly`."""
    return nightly if ThisRun.nightly else usual


@cache
def kinds_of(file: Path) -> frozenset[str]:
    """Return the markers of all tests of a file: `browser`, `process`, `physics`, or none."""
    # A recording is replayed without robots, and what lies elsewhere is not ours.
    return _kinds_of(file, set()) if file.suffix == ".py" and file.is_relative_to(ROOT) else frozenset()


def _kinds_of(file: Path, seen: set[Path]) -> frozenset[str]:
    seen.add(file)
    relative = file.relative_to(ROOT).as_posix()
    found = {kind for folder, kind in FOLDERS.items() if relative.startswith(f"{folder}/")}
    found |= {FILES[relative]} if relative in FILES else set()
    for name in _imported(file):
        found |= _kinds_of_module(name)
        helper = _helper(name)
        if helper is not None and helper not in seen:
            found |= _kinds_of(helper, seen)
    return frozenset(found)


@cache
def _kinds_of_module(module: str) -> frozenset[str]:
    return frozenset(kind for start, kind in KINDS.items() if f"{module}.".startswith(f"{start}."))


@cache
def _imported(file: Path) -> frozenset[str]:
    """Every module that a file names, and every name that it takes from one, which may be a module too."""
    found: set[str] = set()
    for module, names in IMPORT.findall(file.read_text(encoding="utf-8")):
        found |= {module, *(f"{module}.{name.strip()}" for name in names.split(",") if name.strip("( "))}
    return frozenset(found)


@cache
def _helper(module: str) -> Path | None:
    """The file of a module of the tests."""
    if not module.startswith("tests."):
        return None
    file = ROOT.joinpath(*module.split(".")).with_suffix(".py")
    return file if file.is_file() else None
