"""The websocket routes, one file per stream, and the proxy to the 3D view."""
