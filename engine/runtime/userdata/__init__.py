"""Userdata: scopes of keys, and the values that they hold."""
