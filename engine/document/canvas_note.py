"""Notes that stand freely on the canvas of a container, for people; they have no meaning for a run."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from engine.document.text.decoding import StrictModel

NoteColour = Literal["yellow", "blue", "green", "pink", "grey"]
"""Colours of the page's design, each with a light and a dark variant."""
Pixels = Annotated[float, Meta(ge=-1_000_000, le=1_000_000)]
NoteExtent = Annotated[float, Meta(ge=40, le=10_000, description="Pixels")]
NoteName = Annotated[str, Meta(pattern="^[A-Za-z0-9_][A-Za-z0-9_-]{0,63}$", description="Letters, digits, `_` and `-`")]


class CanvasNote(StrictModel, frozen=True, kw_only=True):
    """A note on the canvas: plain text, its upper left corner relative to its container, its size, its colour."""

    text: Annotated[str, Meta(max_length=10_000)]
    position: Annotated[tuple[Pixels, Pixels], Meta(description="Pixels, relative to the container, as in `view`")]
    size: Annotated[tuple[NoteExtent, NoteExtent], Meta(description="Width and height in pixels")]
    colour: NoteColour
