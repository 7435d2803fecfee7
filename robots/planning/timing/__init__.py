"""From a path to a trajectory: corner blending and time parameterization (TOPP-RA) within joint limits.

Used only by robots.planning.worker; independent of the scene.
"""
