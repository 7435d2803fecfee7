"""The tables of faults in the documentation have the faults that are tested, with what is expected of each."""

from __future__ import annotations

import pytest

from tests.robots.drivers.fault_cases import recovery
from tests.robots.drivers.write_fault_matrix import HEAD, PAGE, TABLES, FaultTable, written


@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.name or table.driver.kind)
def test_the_page_lists_every_fault_with_its_cause_and_what_recovery_needs(table: FaultTable) -> None:
    """Run `python -m tests.robots.drivers.write_fault_matrix` and commit when this fails."""
    text = PAGE.read_text(encoding="utf-8")
    assert text.startswith(HEAD)
    _, said, after = text.partition(table.head())
    assert said
    rows = after.partition("\n\n")[0].splitlines()
    assert [row.split(" | ")[0].removeprefix("| ") for row in rows] == [case.name for case in table.cases]
    for case, row in zip(table.cases, rows, strict=True):
        _, cause, *_, meanwhile, person = row.split(" | ")
        assert any(each.partition(" b'")[0] in cause for each in case.cause)
        assert (meanwhile, person.removesuffix(" |")) == (case.meanwhile, recovery(case))


def test_tables_that_are_not_written_anew_stay_as_they_are() -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert HEAD + "".join(written(table, text) for table in TABLES) == text
