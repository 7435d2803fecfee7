"""Names of the state folder, the persistent data of a server. Imports nothing: `flexcell stop` must start fast."""

STATE_FOLDER = ".flexcell"
"""Name of the state folder, private to flexcell."""
SERVER_FILE = "server.json"
"""File in it with the address and the tokens of the running server."""
