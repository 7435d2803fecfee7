"""A module that is made of a URDF file."""

from __future__ import annotations

from pathlib import Path

import msgspec


class UrdfModule(msgspec.Struct, frozen=True, kw_only=True):
    """The text of its document, its mesh files by their paths beside it, and a line for all that is left out."""

    text: str
    meshes: dict[str, Path]
    left_out: tuple[str, ...]
