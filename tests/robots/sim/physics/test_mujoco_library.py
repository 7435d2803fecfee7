"""MuJoCo is loaded without windows, which whoever wants them finds as ever."""

from __future__ import annotations

import subprocess
import sys

PROGRAM = """
import sys
from robots.sim.physics.physics import mujoco
before = "glfw.library" in sys.modules
{use}
print(before, "glfw.library" in sys.modules)
"""


def printed(use: str) -> str:
    program = PROGRAM.format(use=use)
    return subprocess.run([sys.executable, "-P", "-c", program], capture_output=True, text=True, check=True).stdout


def test_the_window_library_is_not_loaded_with_mujoco() -> None:
    assert printed("from robots.sim import world") == "False False\n"


def test_it_is_loaded_by_who_imports_it() -> None:
    assert printed("from glfw import get_version") == "False True\n"


def test_it_is_loaded_by_the_contexts_of_mujoco() -> None:
    """With a display or without."""
    use = "try: mujoco.GLContext(8, 8).free()\nexcept Exception: pass"
    assert printed(use) == "False True\n"
