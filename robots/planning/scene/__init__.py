"""The planning scene and its exact geometry: shapes, allowed collisions, the exact checker.

Occupancy as obstacles. For planners, and for vision and workspace; imports no planner.
"""
