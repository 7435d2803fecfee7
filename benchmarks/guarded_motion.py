"""How exactly a guarded move finds the table, and how hard it meets it, by speed, wanted peak and control law.

`python -P benchmarks/guarded_motion.py` prints a table; the left arm of the demo cell, pads of rubber taken as rigid.
With a wanted peak the first 45 mm of 50 are clear.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from engine.bus import SkillBus
from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document.cell import load_cell
from engine.messages import Pose
from engine.skills.arm_control import ControllerName, SetController
from engine.skills.contact import ContactResult, MoveUntilContact
from engine.skills.motion import CartTrapVel

CELL = Path(__file__).parents[1] / "behaviors" / "cells" / "dual_panda.yaml"
ABOVE = Pose(xyz=(-0.1, 0.05, 0.06), xyzw=(1.0, 0.0, 0.0, 0.0))
# Where the pads end before the tool centre point: link, pad and tool centre of the hand's description.
TIP_M = 0.0584 + 0.04525 + 0.0185 / 2 - 0.1034
LAWS: Sequence[ControllerName] = ("joint_impedance", "cartesian_impedance")


async def search(
    bus: SkillBus, *, law: ControllerName, speed_m_s: float, force_n: float, peak_n: float | None = None
) -> ContactResult:
    """Return the result of a search for the table."""
    await bus.call(SetController(controller=law), to="left")
    await bus.send_goal(CartTrapVel(pose=ABOVE, speed=0.5), to="left").result()
    goal = MoveUntilContact(
        direction=(0.0, 0.0, -1.0),
        distance_m=0.1,
        speed_m_s=speed_m_s,
        force_n=force_n,
        peak_n=peak_n,
        clear_m=0.045,
    )
    end = await bus.send_goal(goal, to="left").result()
    if end.result is None:
        raise SystemExit(str(end.cause))
    return end.result


async def main() -> None:
    """Print the table."""
    print("| law | speed mm/s | wanted peak N | found | error mm | force at rest N | peak N | s |")
    print("|---|---:|---:|---|---:|---:|---:|---:|")
    async with OpenCell(load_cell(CELL), store_path=":memory:") as cell:
        for law in LAWS:
            for speed_m_s in (0.005, 0.01, 0.02, 0.05):
                for peak_n in (None, 10.0):
                    result = await search(cell.bus, law=law, speed_m_s=speed_m_s, force_n=5.0, peak_n=peak_n)
                    error_mm = (result.pose.xyz[2] - TIP_M) * 1e3
                    found = "yes" if result.contact else "no"
                    desired = "–" if peak_n is None else f"{peak_n:g}"
                    figures = f"{error_mm:.3f} | {result.force_n:.1f} | {result.peak_n:.1f} | {result.duration_s:.1f}"
                    print(f"| {law} | {speed_m_s * 1e3:.0f} | {desired} | {found} | {figures} |", flush=True)


if __name__ == "__main__":
    run_virtual(main())
