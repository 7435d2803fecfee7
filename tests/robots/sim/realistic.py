"""Worlds whose arms differ from their nominal models."""

from __future__ import annotations

import msgspec

from engine.document import RealismName
from robots.scene.sim_scene import SimScene


def realistic(scene: SimScene, name: RealismName = "typical", *, seed: int = 0) -> SimScene:
    """Return a scene with the errors of a preset."""
    return msgspec.structs.replace(scene, realism=name, seed=seed)
