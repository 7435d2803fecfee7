"""The body of a magnet in the world: its pole face, and the addresses of the parts that it attracts."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from robots.magnet.magnet_model import MagnetModel
from robots.port import Array
from robots.sim.physics.tool_body import Indices, add_box, as_indices

# Ground steel on steel.
_FACE_FRICTION = (0.4, 0.003, 0.0001)
_FACE = "face"


@dataclass(frozen=True, kw_only=True)
class MagnetIndices:
    """Addresses of a magnet: its body, the geometry of its face, and those of the parts that it attracts."""

    model: MagnetModel
    qpos: Indices
    body: int
    face: int
    ferrous: tuple[int, ...]
    home: Array


def finish_magnet(spec: Any, magnet: MagnetModel) -> None:
    """Add the pole face."""
    add_box(spec, magnet.face, name=_FACE, friction=_FACE_FRICTION)


def magnet_indices(model: Any, arm: str, magnet: MagnetModel, *, ferrous: Iterable[str]) -> MagnetIndices:
    """Return the addresses of a magnet on an arm, and of the parts that it attracts."""
    return MagnetIndices(
        model=magnet,
        qpos=as_indices(()),
        body=int(model.body(f"{arm}/{magnet.face.link}").id),
        face=int(model.geom(f"{arm}/{_FACE}").id),
        ferrous=tuple(int(model.geom(part).id) for part in ferrous),
        home=np.zeros(0),
    )
