"""URDF files and their meshes: located, checked, read, joined. Knows no model folders."""
