"""Emulator of a 2F gripper: registers with time, speed, objects and faults behind Modbus and the URCap's text server.

Its fingers are numbers: no physics is behind them.
"""
