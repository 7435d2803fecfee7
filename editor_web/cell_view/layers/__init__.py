"""The layers of the 3D view: each draws one kind of thing from the latest messages."""
