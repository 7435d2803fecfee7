"""Externally Guided Motion of an IRC5: set points over UDP, 250 times a second, asked for by the controller."""
