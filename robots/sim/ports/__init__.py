"""Implementations of `robots.port` on a running world, the same for both hosts. For robots.sim.world."""
