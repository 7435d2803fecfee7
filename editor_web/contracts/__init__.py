"""Protocols for what the server needs from the engine; every package may use them, and they import no other package."""
