"""The simulated world as a device of a cell: its topics, services, snapshots and connection.

For cell composition, vision and workspace.
"""
