"""Real arms: the contract of a connection to one, and of a controller that takes set points."""
