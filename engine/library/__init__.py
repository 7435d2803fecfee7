"""The behaviors of a project folder, loaded and checked, each with its graph."""
