"""Meshes of fixtures: read from files, inspected, decomposed into convex pieces."""
