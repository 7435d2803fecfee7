"""Emulator of an IRC5 with the server programs of abb_driver: motion, state and gripper ports, one client each.

Its axes are numbers that follow joint interpolation in time; in an emulated cell they are those of its world.
"""
