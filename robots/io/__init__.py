"""Byte streams between processes: message framing on sockets.

Imports nothing of robots; planning, vision and sim use it.
"""
