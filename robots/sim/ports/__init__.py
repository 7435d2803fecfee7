"""Implementations of `robots.port` on a running world, alike over both hosts. For robots.sim.world."""
