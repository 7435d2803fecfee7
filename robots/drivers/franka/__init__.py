"""Franka Research 3: the process that owns libfranka, its limits, and its emulator."""
