"""People of a simulated cell: arms that are moved, that robots and parts collide with, and the count of contacts."""
