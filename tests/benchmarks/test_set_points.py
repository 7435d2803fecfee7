"""Random orders to set points are kept between runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks import set_points
from benchmarks.set_points import CellOrders, order_cells, saved_cells
from robots.control.motion_event import SetPointJumped

JUMP = SetPointJumped(
    motion=3, arm="left", before="rest", generator="trajectory", quantity="jerk", ratio=2.0, reason="it jumped"
)


@pytest.fixture
def given(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Replace the cells by ones of which the second jumps; returns the first orders of those executed."""
    executed: list[int] = []

    def order_cell(seed: int, first: int, count: int) -> CellOrders:
        executed.append(first)
        jumps = [JUMP] if first == 50 else []
        return CellOrders(seed=seed, first=first, orders=count, goals={"stop": 1}, jumps=jumps, duration_s=1.0)

    monkeypatch.setattr(set_points, "order_cell", order_cell)
    return executed


def test_cells_that_are_saved_are_not_ordered_again(given: list[int], tmp_path: Path) -> None:
    file = tmp_path / "orders.jsonl"
    order_cells(120, 1, file)
    cells = order_cells(170, 1, file)
    assert given == [0, 50, 100, 100, 150]
    assert [(cell.first, cell.orders, len(cell.jumps)) for cell in cells] == [
        (0, 50, 0),
        (50, 50, 1),
        (100, 50, 0),
        (150, 20, 0),
    ]
    assert cells[1].jumps == [JUMP]


def test_another_seed_has_cells_of_its_own(given: list[int], tmp_path: Path) -> None:
    file = tmp_path / "orders.jsonl"
    order_cells(50, 1, file)
    order_cells(50, 2, file)
    assert given == [0, 0]


def test_a_line_that_was_cut_off_is_ordered_again_and_swallows_nothing(given: list[int], tmp_path: Path) -> None:
    file = tmp_path / "orders.jsonl"
    order_cells(100, 1, file)
    file.write_bytes(file.read_bytes()[:-20])
    order_cells(150, 1, file)
    assert given == [0, 50, 50, 100]
    assert sorted(saved_cells(file)) == [(1, 0, 50), (1, 50, 50), (1, 100, 50)]
