"""The behaviors of a project folder, loaded and checked, and each drawn as a graph."""
