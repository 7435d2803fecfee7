"""Devices of a cell: their sequences, interlocks and readings, over a port that sets outputs and reads inputs."""

from robots.devices.device_port import DevicePort
from robots.devices.device_server import DeviceServer
from robots.devices.equipped_devices import EquippedDevices
from robots.devices.simulated_devices import SimulatedDevices

__all__ = ["DevicePort", "DeviceServer", "EquippedDevices", "SimulatedDevices"]
