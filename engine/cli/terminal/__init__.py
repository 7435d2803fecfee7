"""A run and its operator at the terminal: options, keys, interrupts."""
