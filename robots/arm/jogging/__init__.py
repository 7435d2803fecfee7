"""Jogging of joints and tool, with its limits in the planning scene."""
