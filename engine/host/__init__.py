"""Services of the operating system: child processes, loopback sockets, private files, SQLite files.

Each file is the face of its subject.
"""
