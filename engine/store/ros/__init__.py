"""Entries exchanged with MongoDB collections of ROS messages."""
