"""The scene of a cell as a file for other programs: MJCF, URDF and glTF."""
