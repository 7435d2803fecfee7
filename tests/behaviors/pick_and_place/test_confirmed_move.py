"""An operator sees a way before the arm goes it, and may leave it."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from engine.cell.open_cell import OpenCell
from engine.messages import JointState
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions
from engine.skills.planning import PathPreview
from tests.behaviors.application import BEHAVIORS, Application, causes, shipped_cell
from tests.engine.cli.command import FLEXCELL
from tests.tiers import nightly

BEHAVIOR = "pick_and_place/confirmed_move.yaml"
PLAN = "root/plan"
WAIT_RAD = (-1.1, -1.4915, 1.8008, -1.8801, -1.5708, -1.1)
ASKING = RunOptions(autonomy="low", demand_operator=True)
_LOOK_S, _THINK_S = 0.02, 3.0


@dataclass
class Operator:
    """Looks at the way as soon as it is asked, thinks about it, and does something; `seen` is what there was to see."""

    act: Callable[[Run], None]
    seen: PathPreview | None = None
    joints: list[JointState] = field(default_factory=list[JointState])

    async def __call__(self, run: Run, cell: OpenCell) -> None:
        while not any(waiting.path == PLAN for waiting in run.control.view().waiting):
            await cell.bus.clock.sleep(_LOOK_S)
        self.seen = cell.bus.topic("arm/planned_path", PathPreview).latest
        self._look(cell)
        await cell.bus.clock.sleep(_THINK_S)
        self._look(cell)
        self.act(run)

    @property
    def moved_rad(self) -> float:
        """How far the arm went while the operator thought."""
        first, last = (state.position_rad for state in self.joints)
        return max(abs(a - b) for a, b in zip(first, last, strict=True))

    def _look(self, cell: OpenCell) -> None:
        state = cell.bus.topic("arm/joint_state", JointState).latest
        assert state is not None
        self.joints.append(state)


def test_the_way_is_shown_and_gone_when_the_operator_agrees(tmp_path: Path) -> None:
    """What is shown leads from where the arm stands to where it goes; until then nothing moves."""
    operator = Operator(lambda run: run.control.answer(PLAN))
    done = Application(behavior=BEHAVIOR, cell=shipped_cell("ur10"), meanwhile=operator, supervision=ASKING)
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("reached", "")
    assert operator.seen is not None
    assert (operator.seen.robot, operator.seen.state) == ("arm", "proposed")
    assert operator.seen.joints[0] == pytest.approx(operator.joints[0].position_rad, abs=0.01)
    assert operator.seen.joints[-1] == pytest.approx(WAIT_RAD, abs=0.001)
    assert len(operator.seen.tool_path) == len(operator.seen.joints)
    assert operator.moved_rad < 0.001
    assert done.seen[-1].joints.position_rad == pytest.approx(WAIT_RAD, abs=0.01)


def test_a_way_that_the_operator_refuses_is_not_gone(tmp_path: Path) -> None:
    operator = Operator(lambda run: run.control.force(PLAN, "no_way"))
    left = Application(behavior=BEHAVIOR, cell=shipped_cell("ur10"), meanwhile=operator, supervision=ASKING)
    result = left.run(tmp_path)
    assert result.outcome == "refused"
    assert left.seen[-1].joints.position_rad == pytest.approx(left.seen[0].joints.position_rad, abs=0.001)


def test_without_an_operator_the_way_is_gone_at_once(tmp_path: Path) -> None:
    done = Application(behavior=BEHAVIOR, cell=shipped_cell("ur10"), parameters={"target": "start"})
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("reached", "")
    assert done.left == ["root/plan planned", "root/go reached", "root reached"]


@pytest.mark.parametrize(
    ("lines", "outcome"), [("wait\nanswer\nwait\n", "reached"), nightly("wait\nforce root/plan no_way\n", "refused")]
)
def test_an_operator_on_the_terminal_agrees_or_refuses(tmp_path: Path, lines: str, outcome: str) -> None:
    """As a script on standard input, the way the guide shows it."""
    done = subprocess.run(
        [
            *(FLEXCELL, "run", BEHAVIORS / BEHAVIOR, "--operator", "--autonomy", "low", "--clock", "virtual"),
            *("--store", tmp_path / "store.db", "--journal", "none"),
        ],
        cwd=tmp_path,
        input=lines,
        capture_output=True,
        text=True,
        timeout=100,
        check=False,
    )
    assert f"{outcome} after" in done.stdout + done.stderr
    assert done.returncode == (0 if outcome == "reached" else 1)
