"""People of a simulated cell: moving arms that collide with robots and parts, and their contact statistics."""
