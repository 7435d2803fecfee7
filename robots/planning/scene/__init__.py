"""The planning scene and its exact geometry: shapes, occupancy, allowed collisions, the exact checker.

Used by the planners, vision and workspace; imports no planner.
"""
