"""Canvas of the layers: the scene of all pages, or the scene of one connected page."""

from __future__ import annotations

import viser

Canvas = viser.ViserServer | viser.ClientHandle
CELL = "/cell"
"""Parent node of the bodies of the cell."""
TAUGHT = "/taught"
"""Parent node of the previews of a page, independent of the visible groups."""
PAST = "/past"
"""Parent node of a past scene, beside the live nodes."""
