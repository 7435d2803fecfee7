"""From a path to a trajectory: corner blending and time parameterization (TOPP-RA) within joint limits.

Used by robots.planning.worker for planned paths and by robots.arm for waypoints; independent of the scene.
"""
