"""States that open, close and question a two-finger gripper."""
