"""The map of occupied space from depth images, without what is known."""
