"""Findings about parameters and userdata: types, units, magnitudes, keys, joint targets."""
