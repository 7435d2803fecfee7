"""What a handle in the 3D view says after its page has let go of it."""

from __future__ import annotations

import asyncio
from typing import cast

from editor_web.cell_view import CellView, DragHandle, HandlePull
from editor_web.cell_view.rendering.transforms import WorldPose
from editor_web.teaching.handle_drag import HandleDrag, ShowHandle
from engine.messages import Pose, RobotDescription
from tests.editor_web.fake_backend import FakeBackend

POSE = WorldPose(xyz=(0.0, 0.0, 0.0), xyzw=(0.0, 0.0, 0.0, 1.0))

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
        self.handle: DragHandle | None = None

    def give_handle(self, page: str, handle: DragHandle) -> None:
        del page
        self.handle = handle

    def take_handle(self, page: str, handle: DragHandle) -> None:
        del page
        handle.pulled(HandlePull(phase="start", pose=POSE))
        if self.handle is handle:
            self.handle = None


async def test_a_handle_that_is_pulled_while_its_page_goes_moves_nothing() -> None:
    backend, view = FakeBackend(), PulledView()
    backend.publish("left/description", DESCRIPTION)
    grip = HandleDrag(backend, cast("CellView", view), "page", joggers={}, send=lambda _: None)
    await grip.take(ShowHandle(arm="left"))
    assert view.handle is not None
    grip.held()
    await grip.close()
    await asyncio.sleep(0)
    assert [task.get_name() for task in asyncio.all_tasks() if task.get_name().startswith("handle of")] == []


async def test_a_connection_that_goes_late_takes_only_its_own_handle_away() -> None:
    """A page that came back has another one by then."""
    backend, view = FakeBackend(), PulledView()
    backend.publish("left/description", DESCRIPTION)
    before, after = (
        HandleDrag(backend, cast("CellView", view), "page", joggers={}, send=lambda _: None) for _ in range(2)
    )
    await before.take(ShowHandle(arm="left"))
    await after.take(ShowHandle(arm="left"))
    shown = view.handle
    await before.close()
    assert view.handle is shown
    await after.close()
    assert view.handle is None
