"""Names of the state folder, where a server keeps what outlives it. Imports nothing: `flexcell stop` waits for it."""

STATE_FOLDER = ".flexcell"
"""The name of the folder that is ours alone, wherever it lies."""
SERVER_FILE = "server.json"
"""In it: the address and the tokens of the server that runs there."""
