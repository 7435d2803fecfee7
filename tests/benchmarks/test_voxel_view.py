"""The benchmark of the voxels in the 3D view measures what it says; the figures are not looked at."""

from __future__ import annotations

from benchmarks.voxel_view import SHAPE, draw_times_ms, new_grids
from editor_web.cell_view.layers.occupancy import occupied, surface


def test_every_grid_has_as_many_voxels_to_draw_as_it_should_and_is_another() -> None:
    grids = new_grids(500)
    assert [int(surface(occupied(grid)).sum()) for grid in grids] == [500] * len(grids)
    assert {grid.shape for grid in grids} == {SHAPE}
    assert len({grid.occupied for grid in grids}) == len({grid.revision for grid in grids}) == len(grids)


def test_each_grid_is_drawn() -> None:
    spent = draw_times_ms(new_grids(50)[:30])
    assert len(spent) == 90
    assert min(spent) > 0.0
