"""What tells one compiled world from another: a hash of all that its future depends on but its state."""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np

# The length of all arrays together, that of the paths included.
_COUNTS_PATHS = "nbuffer"


def fingerprint(model: Any) -> str:
    """Return the SHA-256 of a compiled MuJoCo model: bodies, shapes, joints, motors, options.

    Where its mesh files lie on the disk does not count, so a moved installation has the same worlds.
    """
    digest = hashlib.sha256(model.names)
    for owner in (model, model.opt):
        for name in sorted(dir(owner)):
            if name.startswith("_") or "path" in name or name == _COUNTS_PATHS:
                continue
            value = getattr(owner, name)
            if isinstance(value, np.ndarray | int | float):
                digest.update(name.encode())
                digest.update(np.ascontiguousarray(value).tobytes())
    return digest.hexdigest()
