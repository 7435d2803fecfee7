"""Detections in the image of their camera: a rectangle around each, with label and score."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from editor_web.cell_view.rendering.colours import colour_of_name
from editor_web.cell_view.rendering.geometry import Rgb
from engine.skills.vision import Detections, Rectangle

# Smaller images are enlarged to keep the labels readable.
_LEAST_WIDTH_PX = 320
_FONT_PX = 11
_LINE_PX = 2
_PAD_PX = 2
_LIGHT_INK, _DARK_INK = (255, 255, 255), (0, 0, 0)
# Above this brightness, dark text is more readable.
_BRIGHT = 120.0


def label_text(label: str, score: float) -> str:
    """Return the label text of a detection."""
    return f"{label} {score:.2f}"


def draw_labels(shades: NDArray[np.uint8], detections: Detections) -> NDArray[np.uint8]:
    """Return the image (rows x columns x 3), enlarged if small, with a rectangle around each detection.

    Detections without a rectangle are omitted.
    """
    scale = math.ceil(_LEAST_WIDTH_PX / shades.shape[1])
    picture = Image.fromarray(np.repeat(np.repeat(shades, scale, axis=0), scale, axis=1))
    draw, font = ImageDraw.Draw(picture), ImageFont.load_default(_FONT_PX)
    # The best detections are first in the list and drawn on top.
    for detection in reversed(detections.detections):
        if detection.rectangle_px is None:
            continue
        box = _scaled(detection.rectangle_px, detections.image_px, picture.size)
        colour = colour_of_name(detection.label)
        draw.rectangle(box, outline=colour, width=_LINE_PX)
        text = label_text(detection.label, detection.score)
        width, height = draw.textlength(text, font) + 2 * _PAD_PX, _FONT_PX + 2 * _PAD_PX
        left = max(0.0, min(box[0], picture.width - width))
        top = box[1] - height if box[1] >= height else min(box[3], picture.height - height)
        draw.rectangle((left, top, left + width, top + height), fill=colour)
        draw.text((left + _PAD_PX, top), text, fill=_ink(colour), font=font)
    return np.asarray(picture)


def _ink(ground: Rgb) -> Rgb:
    """Return the text colour for a background."""
    red, green, blue = ground
    return _DARK_INK if 0.299 * red + 0.587 * green + 0.114 * blue > _BRIGHT else _LIGHT_INK


def _scaled(rectangle: Rectangle, of_px: tuple[int, int], to_px: tuple[int, int]) -> Rectangle:
    """Return a rectangle, bounds inclusive, scaled from an image of one size to another."""
    across, down = to_px[0] / of_px[0], to_px[1] / of_px[1]
    left, top, right, bottom = rectangle
    return (left * across, top * down, (right + 1.0) * across - 1.0, (bottom + 1.0) * down - 1.0)
