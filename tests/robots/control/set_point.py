"""A set point for tests of controllers."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from robots.port import Array


@dataclass
class StillPoint:
    """Implements `SetPoint`."""

    position: Array
    velocity: Array = field(default_factory=lambda: np.zeros(2))
    acceleration: Array = field(default_factory=lambda: np.zeros(2))
