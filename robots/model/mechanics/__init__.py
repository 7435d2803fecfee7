"""Kinematics, dynamics and self-collision of one arm with its tool."""
