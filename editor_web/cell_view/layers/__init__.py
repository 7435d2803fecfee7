"""The layers of the 3D view: each draws one kind of object from the latest messages."""
