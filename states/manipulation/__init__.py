"""States that pick and place a part: approach, tool, and planning scene."""
