"""Questions of one arm to the planners of its workspace: paths, and whether trajectories are free."""
