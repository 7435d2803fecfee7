"""The arrow of the drag handle, as it is seen on the screen."""

from __future__ import annotations

from io import BytesIO
from typing import Any, Literal

import numpy as np
from PIL import Image
from playwright.sync_api import Page

from tests.editor_web.limits import GUARD_MS


def tip_of_the_blue_arrow(page: Page, end: Literal["highest", "lowest"]) -> tuple[float, float] | None:
    """Where the arrow along z ends on the screen, as long as nothing else in the view is of that blue."""
    box = page.locator("iframe[title='3D view of the cell']").bounding_box()
    assert box is not None
    area: Any = {key: box[key] for key in ("x", "y", "width", "height")}
    picture = np.asarray(Image.open(BytesIO(page.screenshot(clip=area, timeout=GUARD_MS))).convert("RGB"), dtype=int)
    red, green, blue = (picture[..., channel] for channel in range(3))
    rows, columns = np.nonzero((blue > 200) & (red < 90) & (green > 100) & (green < 160))
    if len(rows) < 50:
        return None
    tip = rows < rows.min() + 8 if end == "highest" else rows > rows.max() - 8
    return box["x"] + float(columns[tip].mean()), box["y"] + float(rows[tip].mean())
