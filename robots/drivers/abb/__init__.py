"""ABB IRC5 over simple_message: codec, links, downloads, port, connection, emulator. Never run on hardware."""
