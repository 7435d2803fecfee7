"""States of a switchable magnet."""
