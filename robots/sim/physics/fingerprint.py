"""The fingerprint of a compiled world: a hash of everything that determines its behavior, except its state."""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np

# The total length of all arrays, including that of the paths.
_COUNTS_PATHS = "nbuffer"


def fingerprint(model: Any) -> str:
    """Return the SHA-256 of a compiled MuJoCo model: bodies, shapes, joints, motors, options.

    The paths of its mesh files are excluded, so a moved installation has the same fingerprints.
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
