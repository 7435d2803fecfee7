"""The table of faults in the documentation has the faults that are tested, with what is expected of each."""

from __future__ import annotations

from tests.robots.drivers.fault_cases import CASES, recovery
from tests.robots.drivers.write_fault_matrix import PAGE, page


def test_the_page_lists_every_fault_with_its_cause_and_what_recovery_needs() -> None:
    """Run `python -m tests.robots.drivers.write_fault_matrix` and commit when this fails."""
    text = PAGE.read_text(encoding="utf-8")
    head, _, table = text.partition("|---|---|---|---|---|\n")
    assert f"{head}|---|---|---|---|---|\n" == page([])
    rows = table.splitlines()
    assert [row.split(" | ")[0].removeprefix("| ") for row in rows] == [case.name for case in CASES]
    for case, row in zip(CASES, rows, strict=True):
        _, cause, _, fingers, person = row.split(" | ")
        assert any(each.partition(" b'")[0] in cause for each in case.cause)
        assert (fingers, person.removesuffix(" |")) == (case.fingers, recovery(case))
