"""Perception: simulated depth images, the occupancy map of unknown objects, and object detection."""
