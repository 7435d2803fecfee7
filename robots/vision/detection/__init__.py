"""Detections of known parts: the ideal detector, and its topic and service."""
