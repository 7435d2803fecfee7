"""Parts in the scene of franky-sim that another world keeps: where that has them, at rest, until it frees them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from engine.messages import Pose


class MirroredParts:
    """Owned by the loop of the simulator; call `place` before each step."""

    def __init__(self, model: Any, data: Any) -> None:
        self._model = model
        self._data = data
        self._kept: dict[str, tuple[float, ...]] = {}

    def take(self, parts: Mapping[str, Pose | None]) -> None:
        """Take where the other world has parts, and let those go on freely that have None."""
        for name, pose in parts.items():
            if pose is None:
                self._kept.pop(name, None)
            else:
                x, y, z, w = pose.xyzw
                self._kept[name] = (*pose.xyz, w, x, y, z)

    def place(self) -> None:
        """Place the parts that are kept."""
        for name, place in self._kept.items():
            joint = self._data.joint(name)
            joint.qpos[:] = place
            joint.qvel[:] = 0.0
