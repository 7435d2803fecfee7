"""Importing robots loads neither numba nor EAIK: they take a third of a second that most programs need not spend."""

from __future__ import annotations

import subprocess
import sys

import pytest

PROGRAM = "import sys, {module}; print([name for name in ('numba', 'eaik') if name in sys.modules])"


@pytest.mark.parametrize("module", ["robots.model.inverse_kinematics", "robots.arm", "robots.sim.simulated_cell"])
def test_importing_robots_loads_no_compiler(module: str) -> None:
    """Only a request does."""
    command = [sys.executable, "-P", "-c", PROGRAM.format(module=module)]
    assert subprocess.run(command, capture_output=True, text=True, check=True).stdout == "[]\n"
