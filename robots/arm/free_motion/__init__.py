"""Collision-free motions: planned, monitored, stopped before obstacles and replanned."""
