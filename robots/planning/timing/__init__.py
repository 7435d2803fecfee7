"""From a path to a trajectory: corner blending and time parameterization (TOPP-RA) within joint limits.

For robots.planning.worker only; knows no scene.
"""
