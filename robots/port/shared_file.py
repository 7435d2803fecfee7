"""Unnamed files in memory that processes share by descriptor."""

from __future__ import annotations

import os
import tempfile


def new_shared_file(name: str) -> int:
    """Return the descriptor of an empty file in memory, labelled `name` in lists of descriptors.

    It vanishes with its last user.
    """
    if hasattr(os, "memfd_create"):
        return os.memfd_create(name)
    with tempfile.TemporaryFile() as file:
        return os.dup(file.fileno())
