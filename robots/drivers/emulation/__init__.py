"""What emulators of all device families share: byte streams over TCP and pty, faults of the wire, the side channel.

Programs of their own; nothing of a cell imports them.
"""
