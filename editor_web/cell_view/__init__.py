"""The 3D view of the cell: the only package that knows viser.

`lock` starts viser behind a secret header, `view` is the open view, `follow` and `newest` hand it the messages
of the bus. Each kind of thing is drawn by a module of its own; `groups` says what each page shows, `past_pages` draws
for single pages what was at another time, `handles` are what somebody pulls at with the mouse.
"""

from editor_web.cell_view.handles import DragHandle, HandlePull
from editor_web.cell_view.past_view import PastViewState
from editor_web.cell_view.rendering.layer_groups import LAYER_GROUPS, LayerGroup
from editor_web.cell_view.rendering.viser_gateway import KEY_HEADER, PAGE_HEADER, ROLE_HEADER, viser_page
from editor_web.cell_view.view import CellView

__all__ = [
    "KEY_HEADER",
    "LAYER_GROUPS",
    "PAGE_HEADER",
    "ROLE_HEADER",
    "CellView",
    "DragHandle",
    "HandlePull",
    "LayerGroup",
    "PastViewState",
    "viser_page",
]
