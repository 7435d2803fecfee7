"""Path search: compiled planners, OMPL and STOMP, endpoints, and checks of given paths.

For robots.planning.worker only, besides `arm_spheres` (vision) and `reachability` (installed models).
"""
