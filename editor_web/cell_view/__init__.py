"""The 3D view of the cell: the only package that depends on viser.

`rendering.viser_gateway` starts viser behind a secret header, `view` is the open view, `topic_subscriptions` and
`rendering.latest_messages` provide the messages of the bus. `layers` has one module for each kind of object;
`rendering.layer_groups` selects what each page shows, `past_view` draws past states for single pages, `handles` are
drag handles for the mouse.
"""

from editor_web.cell_view.handles import DragHandle, HandlePull
from editor_web.cell_view.layers.marks import NO_MARKS, Marks
from editor_web.cell_view.past_view import GhostRequest, PastViewState
from editor_web.cell_view.rendering.layer_groups import LAYER_GROUPS, LayerGroup
from editor_web.cell_view.rendering.viser_gateway import KEY_HEADER, PAGE_HEADER, ROLE_HEADER, viser_page
from editor_web.cell_view.view import CellView

__all__ = [
    "KEY_HEADER",
    "LAYER_GROUPS",
    "NO_MARKS",
    "PAGE_HEADER",
    "ROLE_HEADER",
    "CellView",
    "DragHandle",
    "GhostRequest",
    "HandlePull",
    "LayerGroup",
    "Marks",
    "PastViewState",
    "viser_page",
]
