"""The 3D view of the cell: the only package that knows viser.

`lock` starts viser behind a secret header, `view` is the open view, `follow` and `newest` hand it the messages
of the bus. Each kind of thing is drawn by a module of its own; `groups` says what each page shows, `past_pages` draws
for single pages what was at another time, `handles` are what somebody pulls at with the mouse.
"""

from editor_web.cell_view.groups import GROUPS, Group
from editor_web.cell_view.handles import Handle, Pull
from editor_web.cell_view.lock import KEY_HEADER, PAGE_HEADER, ROLE_HEADER, page
from editor_web.cell_view.past_pages import PastState
from editor_web.cell_view.view import CellView

__all__ = [
    "GROUPS",
    "KEY_HEADER",
    "PAGE_HEADER",
    "ROLE_HEADER",
    "CellView",
    "Group",
    "Handle",
    "PastState",
    "Pull",
    "page",
]
