"""States that ask what the cameras of a cell see."""
