"""Services of the operating system: child processes, loopback sockets, private files, SQLite files."""
