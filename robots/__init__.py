"""Robots, simulated and real: whatever answers skills on the bus."""
