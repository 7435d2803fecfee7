"""What a handle in the 3D view says after its page has let go of it."""

from __future__ import annotations

import asyncio
from typing import cast

from editor_web.cell_view import CellView, Handle, Pull
from editor_web.cell_view.placement import Placed
from editor_web.grip import Grip, Take
from engine.messages import Pose, RobotDescription
from tests.editor_web.fake_backend import FakeBackend

POSE = Placed(xyz=(0.0, 0.0, 0.0), xyzw=(0.0, 0.0, 0.0, 1.0))

DESCRIPTION = RobotDescription(
    name="left",
    model="panda",
    urdf="",
    joint_names=(),
    lower_rad=(),
    upper_rad=(),
    velocity_rad_s=(),
    acceleration_rad_s2=(),
    base=Pose(xyz=(0.0, 0.0, 0.0)),
    tool_frame="left/tool",
)


class PulledView:
    """Its handle is pulled at just while it is taken away."""

    def __init__(self) -> None:
        self.handle: Handle | None = None

    def give_handle(self, page: str, handle: Handle) -> None:
        del page
        self.handle = handle

    def take_handle(self, page: str, handle: Handle) -> None:
        del page
        handle.pulled(Pull(phase="start", pose=POSE))
        if self.handle is handle:
            self.handle = None


async def test_a_handle_that_is_pulled_while_its_page_goes_moves_nothing() -> None:
    backend, view = FakeBackend(), PulledView()
    backend.publish("left/description", DESCRIPTION)
    grip = Grip(backend, cast("CellView", view), "page", joggers={}, tell=lambda _: None)
    await grip.take(Take(arm="left"))
    assert view.handle is not None
    grip.held()
    await grip.close()
    await asyncio.sleep(0)
    assert [task.get_name() for task in asyncio.all_tasks() if task.get_name().startswith("handle of")] == []


async def test_a_connection_that_goes_late_takes_only_its_own_handle_away() -> None:
    """A page that came back has another one by then."""
    backend, view = FakeBackend(), PulledView()
    backend.publish("left/description", DESCRIPTION)
    before, after = (Grip(backend, cast("CellView", view), "page", joggers={}, tell=lambda _: None) for _ in range(2))
    await before.take(Take(arm="left"))
    await after.take(Take(arm="left"))
    shown = view.handle
    await before.close()
    assert view.handle is shown
    await after.close()
    assert view.handle is None
