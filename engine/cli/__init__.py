"""The command line: one file a command, one line an error, exit codes that mean something."""
