"""What the computer gives: child processes, loopback sockets, private files, SQLite files.

Turns of the event loop.
"""
