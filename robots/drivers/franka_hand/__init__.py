"""Franka Hand over its own port of the control cabinet: protocol, motions and device; no client library."""
