"""Universal Robots controllers, CB3 and e-Series: their emulator, and the process that owns the client library."""
