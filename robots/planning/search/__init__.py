"""Path search: compiled planners, OMPL and STOMP, endpoint checks, and checks of given paths.

Used only by robots.planning.worker, except `arm_spheres` (vision) and `reachability` (installed models).
"""
