"""What is wrong with a mesh file that a fixture names."""

from __future__ import annotations

from typing import Literal

import msgspec


class MeshDefect(msgspec.Struct, frozen=True, kw_only=True):
    """A defect: `key` is that of the fixture; with one that is `unusable` no cell can be opened."""

    key: Literal["file", "scale"] = "file"
    message: str
    hint: str = ""
    unusable: bool = False
