"""Robots, simulated and real: devices that serve skills on the bus."""

# Must be the first import: it prepares the types of every module of this package at import time.
import engine  # noqa: F401  # pyright: ignore[reportUnusedImport]
