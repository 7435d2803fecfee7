"""Where things are drawn: in the scene that everybody sees, or in that of one connected page only."""

from __future__ import annotations

import viser

Canvas = viser.ViserServer | viser.ClientHandle
CELL = "/cell"
"""The node that the bodies of the cell are below."""
TAUGHT = "/taught"
"""The node that what somebody looks at is below, whatever else is shown or hidden."""
PAST = "/past"
"""The node that everything of a past moment is below, beside the live nodes."""
