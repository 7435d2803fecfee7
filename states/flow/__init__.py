"""States that need no robot: waiting, logging, deciding, setting values."""
