"""Robots, simulated and real: whatever answers skills on the bus."""

# First of all, so that the types of every module in here are made ready as it is imported.
import engine  # noqa: F401  # pyright: ignore[reportUnusedImport]
