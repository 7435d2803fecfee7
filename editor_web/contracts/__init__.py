"""What the server asks of the engine, as structural contracts; every room may use it.

And it imports no other room.
"""
