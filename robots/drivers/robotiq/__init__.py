"""Robotiq 2F-85: registers, transports (Modbus RTU, RTU over TCP, Modbus TCP, URCap text), port and device.

Never run on hardware: proven against the emulator in `emulation/`, which foreign client libraries drive too.
"""
