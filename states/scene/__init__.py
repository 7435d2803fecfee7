"""States that tell the planning scene what is in the way, what is carried and what may touch."""
