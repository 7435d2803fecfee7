"""Targets of texts under edit are looked at in a process of its own: one text after the other, the newest one."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from engine.editing.targets.target_checks import TargetChecks
from engine.editing.targets.target_messages import TargetFindings
from engine.editing.targets.target_process import rest_findings, target_findings
from engine.registry import load_states
from tests.engine.editing.target_texts import FAR, IN_POST, REACH, written

GUARD_S = 100.0
ECHO = """
import socket, sys
connection = socket.socket(fileno=int(sys.argv[1]))
for line in connection.makefile("rb"):
    if b"hang" in line:
        continue
    if b"die" in line:
        break
    connection.sendall(b'{"problem": "looked"}' + bytes([10]))
"""
"""A process that has no answer to `hang`, ends at `die`, and has looked at everything else."""


@pytest.mark.parametrize(
    ("text", "codes"),
    [(REACH, []), (FAR, ["unreachable-target"]), (IN_POST, ["target-in-collision"]), ("root: [", [])],
)
def test_a_target_is_found_at_its_node_and_line(tmp_path: Path, text: str, codes: list[str]) -> None:
    """What cannot be read has none."""
    file = written(tmp_path)
    found = target_findings(text, file, tmp_path, load_states()).findings
    assert [each.code for each in found] == codes
    assert {(each.severity, each.path, each.line) for each in found} <= {("warning", "root/go", 12)}


def test_a_text_that_leads_out_of_the_project_is_not_looked_at(tmp_path: Path) -> None:
    """Its cell may be anything."""
    (tmp_path / "mine").mkdir()
    file = written(tmp_path / "mine")
    text = FAR.replace("cell: bench.yaml", "cell: ../../behaviors/bench.yaml")
    written(tmp_path)
    assert target_findings(text, file, tmp_path / "mine", load_states()) == TargetFindings()


async def test_the_process_answers_as_the_function_does(tmp_path: Path) -> None:
    """It starts with the first text and is gone after `close`."""
    file = written(tmp_path)
    checks = TargetChecks(tmp_path, limit_s=GUARD_S)
    assert checks.pid == 0
    try:
        found = await checks.findings("page", file, FAR)
        assert found is not None
        assert found == target_findings(FAR, file, tmp_path, load_states())
    finally:
        checks.close()
    assert checks.pid == 0


async def test_of_the_texts_that_wait_the_latest_of_each_asker_is_looked_at(tmp_path: Path) -> None:
    """One that is being looked at is answered; those between are dropped."""
    checks = TargetChecks(tmp_path, limit_s=GUARD_S, start=ECHO)
    asked = [("a", "1"), ("a", "2"), ("a", "3"), ("b", "4")]
    try:
        found = await asyncio.gather(*(checks.findings(asker, tmp_path / "x.yaml", text) for asker, text in asked))
    finally:
        checks.close()
    looked = TargetFindings(problem="looked")
    assert found == [looked, None, looked, looked]


@pytest.mark.parametrize(
    ("text", "limit_s", "problem"), [("hang", 0.2, "no answer within 0.2 s"), ("die", GUARD_S, "has ended")]
)
async def test_a_process_that_does_not_answer_is_reported_and_the_next_text_has_another(
    tmp_path: Path, text: str, limit_s: float, problem: str
) -> None:
    """It hangs, or dies."""
    checks = TargetChecks(tmp_path, limit_s=limit_s, start=ECHO)
    try:
        found = await checks.findings("page", tmp_path / "x.yaml", text)
        assert found is not None
        assert found.findings == ()
        assert problem in found.problem
        checks.limit_s = GUARD_S
        again = await checks.findings("page", tmp_path / "x.yaml", "well")
    finally:
        checks.close()
    assert again == TargetFindings(problem="looked")


def test_what_touches_at_rest_is_found_at_both_items_with_their_lines(tmp_path: Path) -> None:
    text = (
        "flexcell: 1\ncell: bench\nworld: {kind: mujoco}\nfixtures:\n"
        "  table: {shape: box, size_m: [1, 1, 0.1], at: {xyz: [0, 0, 0.05]}}\nparts:\n"
        "  block: {shape: box, size_m: [0.1, 0.1, 0.1], mass_kg: 1, at: {xyz: [0, 0, 0.13]}}\n"
    )
    found = rest_findings(text, tmp_path / "cell.yaml").findings
    assert {(each.path, each.line, each.message) for each in found} == {
        ("fixtures/table", 5, "`table` and `block` overlap by 20.0 mm while everything is at rest"),
        ("parts/block", 7, "`table` and `block` overlap by 20.0 mm while everything is at rest"),
    }
    assert rest_findings("fixtures: [", tmp_path / "cell.yaml") == TargetFindings()


async def test_a_cell_is_looked_at_in_the_process(tmp_path: Path) -> None:
    checks = TargetChecks(tmp_path)
    try:
        text = "flexcell: 1\ncell: bench\n"
        async with asyncio.timeout(GUARD_S):
            assert await checks.findings("page", tmp_path / "cell.yaml", text, of="cell") == TargetFindings()
    finally:
        checks.close()
