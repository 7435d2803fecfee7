"""Behavior references: parameters and keys pass only where named, any number of instances."""

from __future__ import annotations

from pathlib import Path

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import load_behavior
from engine.runtime.plan import new_plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult
from tests.engine.fake_states import CATALOGUE

COUNTER = """
flexcell: 1
name: counter
parameters: {limit: {type: integer, default: 2}}
userdata: {count: 0, hidden: 1}
outcomes: [full]
success: [full]
root:
  machine:
    initial: count
    states:
      count: {state: test.Count, with: {up_to: "${limit}"}, transitions: {more: count, full: full}}
"""
OUTER = """
flexcell: 1
name: outer
userdata: {total: 0, start: 3}
outcomes: [good]
success: [good]
root:
  machine:
    initial: first
    states:
      first: {behavior: counter.yaml, with: {limit: 5}, out: {count: total}, transitions: {full: second}}
      second:
        behavior: counter.yaml
        in: {count: start}
        with: {limit: "${total + 1}"}
        out: {count: start}
        transitions: {full: good}
"""


def _run(tmp_path: Path, outer: str) -> RunResult:
    (tmp_path / "counter.yaml").write_text(COUNTER, encoding="utf-8")
    (tmp_path / "outer.yaml").write_text(outer, encoding="utf-8")
    plan = new_plan(load_behavior(tmp_path / "outer.yaml"), CATALOGUE)

    async def main() -> RunResult:
        return await Run(plan, run="r", bus=SkillBus(new_clock())).execute()

    return run_virtual(main())


def test_parameters_and_keys_pass_by_name(tmp_path: Path) -> None:
    """Two instances with parameters of their own; what `out` names comes back, nothing else."""
    result = _run(tmp_path, OUTER)
    assert (result.outcome, dict(result.userdata)) == ("good", {"total": 5, "start": 6})


def test_a_parameter_that_does_not_fit_names_behavior_and_parameter(tmp_path: Path) -> None:
    """Values are checked at the wall between behaviors."""
    result = _run(tmp_path, OUTER.replace("${total + 1}", "${string(total)}"))
    assert result.status == "errored"
    assert result.cause is not None
    assert "parameter `limit`: '5' is not an integer" in result.cause.message
    assert result.cause.where == "counter"
