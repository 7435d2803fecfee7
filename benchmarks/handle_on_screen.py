"""Where the axes of the handle in the 3D view are on the screen: found in a picture of the page by their colours."""

from __future__ import annotations

import io
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from playwright.sync_api import Page
from scipy import ndimage

# Of viser's transform controls as they appear: X, Y, Z; the ball in the middle is flexcell's.
_COLOURS = ((253, 112, 158), (168, 232, 192), (128, 180, 235))
_BALL = (118, 148, 240)
_NEAR, _LEAST_PIXELS = 50, 12
# Where an arrow is gripped, of its length: at its head, since arcs cross its shaft. And how far it is pulled.
_GRIP, _PULL = 0.88, 0.25


@dataclass(frozen=True, kw_only=True)
class Arrow:
    """One axis of the handle: where a mouse grips it, and how far one pull goes along it, in pixels of the page."""

    axis: int
    grip: tuple[float, float]
    along: tuple[float, float]


def find_arrows(page: Page) -> list[Arrow]:
    """Return the axes that are long enough on the screen to be pulled."""
    view = page.locator("iframe[title='3D view of the cell']")
    box = view.bounding_box()
    assert box is not None
    picture = Image.open(io.BytesIO(page.screenshot(timeout=600_000))).convert("RGB")
    left, top = int(box["x"]), int(box["y"])
    pixels = np.asarray(picture, dtype=np.int64)[
        top : int(box["y"] + box["height"]), left : int(box["x"] + box["width"])
    ]
    near = [np.abs(pixels - np.array(colour)).sum(axis=2) < _NEAR for colour in (*_COLOURS, _BALL)]
    # Other things in the cell have these colours too: the handle is what hangs together with its ball.
    # The functions are typed in part only: Any contains them here.
    places: NDArray[np.int64] = cast("Any", ndimage).label(
        cast("Any", ndimage).binary_dilation(np.logical_or.reduce(near), iterations=3)
    )[0]
    handle = places == np.argmax(np.bincount(places[near[-1]]))
    *found, ball = [_points(mask & handle) for mask in near]
    centre = np.median(ball, axis=0)
    arrows: list[Arrow] = []
    for axis, points in enumerate(found):
        if len(points) < _LEAST_PIXELS:
            continue
        tip = points[int(np.argmax(np.linalg.norm(points - centre, axis=1)))]
        grip, along = centre + _GRIP * (tip - centre), _PULL * (tip - centre)
        arrows.append(
            Arrow(
                axis=axis,
                grip=(float(grip[0]) + left, float(grip[1]) + top),
                along=(float(along[0]), float(along[1])),
            )
        )
    return arrows


def _points(mask: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Return the pixels of a mask, as x and y."""
    rows, columns = np.nonzero(mask)
    return np.stack((columns, rows), axis=1).astype(np.float64)
