"""Emulator of a SoftHand: position and current with time, an object and faults, on a pty or a TCP port.

Its fingers are one number: no physics is behind them.
"""
