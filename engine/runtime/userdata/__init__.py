"""Userdata: scopes of keys, and their values."""
