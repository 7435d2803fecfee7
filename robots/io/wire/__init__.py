"""Connections to devices, TCP, UDP and serial, whose bytes can be captured to files that Wireshark reads.

Imports nothing of robots. Drivers open their connections here, so that one place captures all of them.
"""
