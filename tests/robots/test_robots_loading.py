"""Importing robots loads no compiler and no scipy: each takes most of a second that few programs need."""

from __future__ import annotations

import subprocess
import sys

import pytest

PROGRAM = "import sys, {module}; print([name for name in ('numba', 'eaik', 'scipy') if name in sys.modules])"


@pytest.mark.parametrize(
    "module",
    [
        "robots.model.inverse_kinematics",
        "robots.arm",
        "robots.simulated_cell",
        "editor_web.server",
        # On the event loop of the engine, at the first request.
        "robots.planning.worker.planning_worker",
        "robots.vision.camera_process",
    ],
)
def test_importing_loads_only_what_every_program_needs(module: str) -> None:
    """Only a request does."""
    command = [sys.executable, "-P", "-c", PROGRAM.format(module=module)]
    assert subprocess.run(command, capture_output=True, text=True, check=True).stdout == "[]\n"


@pytest.mark.parametrize("module", ["robots.control.kernels", "robots.model.inverse_kinematics.kernels"])
def test_compiled_functions_load_no_linear_algebra_that_they_do_not_call(module: str) -> None:
    """scipy's would be a third of what a first motion loads."""
    program = f"import sys, {module}; print('scipy.linalg' in sys.modules)"
    assert subprocess.run([sys.executable, "-P", "-c", program], capture_output=True, text=True, check=True).stdout == (
        "False\n"
    )
