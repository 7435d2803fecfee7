"""The unknown voxels that are drawn: those older than the limit, on changes only, and none from garbage."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest
import viser

from editor_web.cell_view.layers.unknown_space import PERIOD_S, UnknownSpaceLayer, unknown
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from engine.messages.sensing import NEVER_SEEN, ObservedSpace

SHAPE = (4, 5, 6)


def space(*ages: int, time_s: float = 0.0) -> ObservedSpace:
    """Return a map that was seen just now, but for the first voxels."""
    values = np.zeros(SHAPE, dtype=np.uint8)
    values.reshape(-1)[: len(ages)] = ages
    return ObservedSpace(
        time_s=time_s, corner_m=(0.1, 0.2, 0.3), voxel_m=0.1, shape=SHAPE, limit_s=5.0, ages=values.tobytes()
    )


def points(server: viser.ViserServer) -> int:
    """Return the number of points of the layer."""
    handle = server.scene.get_handle_by_name("/voxels/unknown")
    assert isinstance(handle, viser.PointCloudHandle)
    return len(handle.points) if handle.visible else 0


def test_voxels_older_than_the_limit_are_unknown() -> None:
    found = unknown(space(50, 51, 254, NEVER_SEEN))
    assert found.reshape(-1)[:5].tolist() == [False, True, True, True, False]


@pytest.mark.parametrize("change", [{"ages": b""}, {"shape": (-1, 8, 1)}])
def test_ages_that_do_not_fit_the_shape_are_refused_and_not_drawn(
    server: viser.ViserServer, change: dict[str, object]
) -> None:
    broken = msgspec.structs.replace(space(), **change)
    with pytest.raises(ValueError, match="do not match a map"):
        unknown(broken)
    newest = LatestMessages()
    newest.put("cell", broken)
    assert UnknownSpaceLayer(server).draw(newest, 0.0) is None
    assert server.scene.get_handle_by_name("/voxels/unknown") is None


def test_changes_are_drawn_twice_a_second_at_most(server: viser.ViserServer) -> None:
    layer, newest = UnknownSpaceLayer(server), LatestMessages()
    assert layer.draw(newest, 0.0) is None
    newest.put("cell", space(NEVER_SEEN, NEVER_SEEN))
    assert layer.draw(newest, 0.0) is None
    assert points(server) == 2
    newest.put("cell", space(NEVER_SEEN, time_s=0.1))
    assert layer.draw(newest, 0.1) == PERIOD_S
    assert layer.draw(newest, PERIOD_S) is None
    assert points(server) == 1
    newest.put("cell", space(time_s=1.0))
    layer.draw(newest, 2.0 * PERIOD_S)
    assert points(server) == 0
