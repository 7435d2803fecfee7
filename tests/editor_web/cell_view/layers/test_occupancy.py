"""The voxels that are drawn: exactly those that can be seen, from any grid, and none from garbage."""

from __future__ import annotations

import itertools

import msgspec
import numpy as np
import pytest
import viser
from hypothesis import given
from hypothesis import strategies as st

from editor_web.cell_view.layers.occupancy import PERIOD_S, VoxelLayer, occupied, surface
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from engine.messages.sensing import OccupancyGrid
from tests.editor_web.fake_sights import occupancy, occupancy_state

sizes = st.integers(1, 5)


@given(st.tuples(sizes, sizes, sizes), st.integers(0, 1000))
def test_a_voxel_is_seen_where_one_of_its_sides_is_free(shape: tuple[int, int, int], seed: int) -> None:
    taken = np.random.default_rng(seed).random(shape) < 0.8
    around = np.pad(taken, 1)
    expected = np.zeros(shape, dtype=bool)
    for x, y, z in itertools.product(*map(range, shape)):
        steps = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))
        free = any(not around[x + 1 + i, y + 1 + j, z + 1 + k] for i, j, k in steps)
        expected[x, y, z] = taken[x, y, z] and free
    assert np.array_equal(surface(taken), expected)


def test_the_bits_of_a_grid_are_read_z_fastest() -> None:
    taken = np.zeros((2, 3, 5), dtype=bool)
    taken[1, 0, 4] = True
    grid = OccupancyGrid(
        time_s=0.0, revision=1, corner_m=(0, 0, 0), voxel_m=0.1, shape=(2, 3, 5), occupied=np.packbits(taken).tobytes()
    )
    assert np.array_equal(occupied(grid), taken)


@pytest.mark.parametrize("change", [{"occupied": b""}, {"occupied": b"\xff" * 9}, {"shape": (-1, 8, 1)}])
def test_bits_that_do_not_fit_the_shape_are_refused(change: dict[str, object]) -> None:
    grid = msgspec.structs.replace(occupancy(), **{"shape": (2, 3, 5), **change})
    with pytest.raises(ValueError, match="do not match a grid"):
        occupied(grid)


def drawn(server: viser.ViserServer) -> viser.PointCloudHandle:
    """What the server has of the voxels."""
    handle = server.scene.get_handle_by_name("/voxels/occupied")
    assert isinstance(handle, viser.PointCloudHandle)
    return handle


def test_a_grid_is_drawn_ten_times_a_second_at_most_and_the_latest_one_in_the_end(server: viser.ViserServer) -> None:
    voxels, newest = VoxelLayer(server), LatestMessages()
    assert voxels.draw(newest, 0.0) is None
    for reach in (0.0, 0.3):
        newest.put("cell", occupancy(revision=1 + round(reach * 10), reach=reach))
        due_s = voxels.draw(newest, 0.0)
    assert due_s == PERIOD_S
    assert len(drawn(server).points) == int(surface(occupied(occupancy())).sum())
    assert voxels.draw(newest, PERIOD_S) is None
    assert len(drawn(server).points) == int(surface(occupied(occupancy(reach=0.3))).sum())
    assert drawn(server).position.tolist() == [-0.5, -0.6, 0.0]


def test_voxels_are_coloured_by_their_height_and_grey_when_the_map_is_out_of_date(server: viser.ViserServer) -> None:
    voxels, newest = VoxelLayer(server), LatestMessages()
    newest.put("cell", occupancy())
    voxels.draw(newest, 0.0)
    order = np.argsort(drawn(server).points[:, 2].astype(float), kind="stable")
    lowest, highest = drawn(server).colors[order[[0, -1]]].astype(int)
    assert highest[1] - lowest[1] > 100
    newest.put("cell", occupancy_state(stale_reason="no camera images"))
    voxels.draw(newest, 1.0)
    assert (np.ptp(drawn(server).colors.astype(int), axis=1) == 0).all()
    newest.put("cell", occupancy_state())
    voxels.draw(newest, 2.0)
    assert np.ptp(drawn(server).colors.astype(int), axis=1).max() > 50


def test_a_space_that_has_become_free_shows_nothing(server: viser.ViserServer) -> None:
    voxels, newest = VoxelLayer(server), LatestMessages()
    newest.put("cell", occupancy())
    voxels.draw(newest, 0.0)
    newest.put("cell", msgspec.structs.replace(occupancy(), revision=2, occupied=bytes(50 * 60 * 30 // 8)))
    voxels.draw(newest, 1.0)
    assert len(drawn(server).points) == 0


def test_garbage_is_reported_once_and_what_comes_next_is_drawn(
    server: viser.ViserServer, caplog: pytest.LogCaptureFixture
) -> None:
    voxels, newest = VoxelLayer(server), LatestMessages()
    newest.put("cell", msgspec.structs.replace(occupancy(), occupied=b"short"))
    voxels.draw(newest, 0.0)
    voxels.draw(newest, 1.0)
    assert caplog.text.count("the occupancy is not drawn") == 1
    newest.put("cell", occupancy(revision=2))
    voxels.draw(newest, 2.0)
    assert len(drawn(server).points) > 100
