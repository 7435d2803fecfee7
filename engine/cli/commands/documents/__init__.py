"""The commands that write something else of a behavior: adapted to another cell, as YAML, as a picture."""
