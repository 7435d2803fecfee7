"""How exactly a guarded move finds the table, and how hard it meets it, by speed and control law.

`python -P benchmarks/guarded_motion.py` prints a table; the left arm of the demo cell, pads of rubber taken as rigid.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from engine.bus import SkillBus
from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document.cell import load_cell
from engine.messages import Pose
from engine.skills.arm_control import ControllerName, ReadArm, SetController
from engine.skills.contact import ContactResult, MoveUntilContact
from engine.skills.motion import CartTrapVel

CELL = Path(__file__).parents[1] / "behaviors" / "cells" / "dual_panda.yaml"
ABOVE = Pose(xyz=(-0.1, 0.05, 0.06), xyzw=(1.0, 0.0, 0.0, 0.0))
# Where the pads end before the tool centre point: link, pad and tool centre of the hand's description.
TIP_M = 0.0584 + 0.04525 + 0.0185 / 2 - 0.1034
LAWS: Sequence[ControllerName] = ("joint_impedance", "cartesian_impedance")


async def search(
    bus: SkillBus, *, law: ControllerName, speed_m_s: float, force_n: float
) -> tuple[ContactResult, float]:
    """Return the result of a search for the table, and the greatest force on the way, looked at every millisecond."""
    await bus.call(SetController(controller=law), to="left")
    await bus.send_goal(CartTrapVel(pose=ABOVE, speed=0.5), to="left").result()
    goal = MoveUntilContact(direction=(0.0, 0.0, -1.0), distance_m=0.1, speed_m_s=speed_m_s, force_n=force_n)
    handle = bus.send_goal(goal, to="left")
    peak_n = 0.0
    while not handle.finished:
        peak_n = max(peak_n, (await bus.call(ReadArm(), to="left")).wrench.force_n[2])
        await bus.clock.sleep(0.001)
    end = await handle.result()
    if end.result is None:
        raise SystemExit(str(end.cause))
    return end.result, peak_n


async def main() -> None:
    """Print the table."""
    print("| law | speed mm/s | found | error mm | force at rest N | peak N |\n|---|---:|---|---:|---:|---:|")
    async with OpenCell(load_cell(CELL), store_path=":memory:") as cell:
        for law in LAWS:
            for speed_m_s in (0.005, 0.01, 0.02, 0.03, 0.05):
                result, peak_n = await search(cell.bus, law=law, speed_m_s=speed_m_s, force_n=5.0)
                error_mm = (result.pose.xyz[2] - TIP_M) * 1e3
                found = "yes" if result.contact else "no"
                figures = f"{error_mm:.3f} | {result.force_n:.1f} | {peak_n:.0f}"
                print(f"| {law} | {speed_m_s * 1e3:.0f} | {found} | {figures} |")


if __name__ == "__main__":
    run_virtual(main())
