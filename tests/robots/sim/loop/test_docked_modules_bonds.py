"""Modules with parts that are joined: these come and go together, and what is broken stays so."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.cell import Cell
from engine.document.docking import cell_as_docked
from engine.skills.simulated_world import PushBody
from robots.sim.commands.world_commands import PlaceModule, PushSimBody
from robots.sim.loop.simulation import Simulation
from robots.sim.loop.snapshot import SimSnapshot
from robots.sim.physics.cell_model import build_cell
from tests.robots.module_cell import CELL, MODULE, module_cell, module_scene

# The flag stands on the block and touches nothing of the tray.
PRODUCT = f"""\
{MODULE}\
  flag: {{shape: box, size_m: [0.02, 0.02, 0.04], mass_kg: 0.05, at: {{frame: slot_1, xyz: [0, 0, 0.0805]}}}}
bonds:
  seam: {{kind: glue, part: flag, to: block, at_m: [0, 0, -0.02], force_n: 5, torque_nm: 1}}
  pad: {{kind: glue, part: block, to: tray, at_m: [0, 0, -0.02], force_n: 50, torque_nm: 5}}
"""


class Docks:
    """A world into which the module is plugged and from which it is unplugged."""

    def __init__(self, folder: Path) -> None:
        self._cell: Cell = module_cell(folder, cell=CELL, module=PRODUCT)
        self.simulation = Simulation(build_cell(module_scene(self._cell)))

    def plug(self, connector: str) -> tuple[str, tuple[str, ...]]:
        """Plug the module, or unplug it, for half a second; return the refusal and the parts of it that are away."""
        pose = cell_as_docked(self._cell, {"full": connector}).fixed_frames["full"] if connector else None
        placed = self.simulation.place_module(PlaceModule(module="full", pose=pose))
        self.pass_time(0.5)
        return placed.refused, tuple(name for name in placed.away if name.startswith("full/"))

    def pass_time(self, time_s: float) -> None:
        """Simulate."""
        for _ in range(round(time_s / self.simulation.step_s)):
            self.simulation.step()

    def broken(self) -> dict[str, str]:
        """Return what has broken the bonds of the module."""
        readings = self._snapshot().bonds()
        return {name: bond.broken_by for name, bond in readings.items() if name.startswith("full/")}

    def height(self, part: str) -> float:
        """Return how high a part is."""
        return float(self._snapshot().frame(part)[0][2])

    def _snapshot(self) -> SimSnapshot:
        values = self.simulation.layout.new_array()
        self.simulation.write_snapshot(values)
        return SimSnapshot(self.simulation.layout, values)


PARTS = ("full/block", "full/ball", "full/flag")
WHOLE = {"full/seam": "", "full/pad": ""}


def test_joined_parts_come_and_go_with_their_module(tmp_path: Path) -> None:
    docks = Docks(tmp_path)
    docks.pass_time(0.2)
    assert docks.broken() == WHOLE
    for connector in ("dock_1", "dock_2"):
        assert docks.plug(connector) == ("", ())
        assert (docks.broken(), docks.height("full/flag")) == (WHOLE, pytest.approx(0.2855, abs=1e-3))
        assert docks.plug("") == ("", PARTS)
        assert docks.broken() == WHOLE


def test_what_has_broken_is_broken_when_the_module_comes_again(tmp_path: Path) -> None:
    docks = Docks(tmp_path)
    docks.plug("dock_1")
    docks.simulation.apply(PushSimBody(push=PushBody(body="full/flag", force_n=(8.0, 0.0, 0.0), duration_s=0.05)))
    docks.pass_time(2.0)
    broken = {"full/seam": "force", "full/pad": ""}
    assert (docks.broken(), docks.height("full/flag") < 0.27) == (broken, True)
    docks.plug("")
    docks.plug("dock_2")
    assert docks.broken() == broken
