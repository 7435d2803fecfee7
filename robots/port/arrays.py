"""The array type of everything numeric: float64, joints in the model's order."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
