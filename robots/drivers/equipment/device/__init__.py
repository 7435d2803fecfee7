"""Equipment as a device of a cell: its driver over the server of its pins, and the same with pins in memory."""
