"""Emulator of a whole cell: one simulated world, and the emulators of the cell's devices on its joints.

A program of its own; nothing of a cell imports it.
"""
