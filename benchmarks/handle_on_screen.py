"""Where the axes of the handle in the 3D view are on the screen: found in a picture of the page by their colours."""

from __future__ import annotations

import io
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from playwright.sync_api import Page

# Of viser's transform controls: X, Y, Z; the ball in the middle is flexcell's.
_COLOURS = ((255, 32, 96), (32, 223, 128), (32, 128, 255))
_NEAR, _LEAST_PIXELS = 60, 12
# Where an arrow is gripped, of its length, and how far it is pulled.
_GRIP, _PULL = 0.75, 0.25


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
    found = [_points(pixels, colour) for colour in _COLOURS]
    centre = np.median(np.vstack([points for points in found if len(points)]), axis=0)
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


def _points(pixels: NDArray[np.int64], colour: tuple[int, int, int]) -> NDArray[np.float64]:
    """Return the pixels of a colour, as x and y."""
    rows, columns = np.nonzero(np.abs(pixels - np.array(colour)).sum(axis=2) < _NEAR)
    return np.stack((columns, rows), axis=1).astype(np.float64)
