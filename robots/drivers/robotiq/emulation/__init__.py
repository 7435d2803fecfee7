"""Emulator of a 2F gripper: registers with time, speed, objects and faults behind Modbus and the URCap's text server.

Its fingers are numbers, or those of a simulated world in an emulated cell.
"""
