"""States that look at the cell as a whole."""
