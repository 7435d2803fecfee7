"""States that open, close and check a two-finger gripper."""
