"""Emulator of the board of a servo arm: servos with limited speed in real time, and faults, on a pty or a TCP port.

It does what the sketch does, or, as `bare`, what a sketch without answers does.
"""
