"""Emulator of a SoftHand: position and current with time, an object and faults, on a pty or a TCP port.

Its fingers are one number; in an emulated cell they are those of its world.
"""
