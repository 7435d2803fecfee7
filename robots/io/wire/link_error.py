"""The failure of a connection to a device."""

from __future__ import annotations


class LinkError(Exception):
    """The device cannot be reached, does not answer in time, or answers what is not understood; says which."""
