"""The server side of the teaching page: its messages, and the stop of motions when its connection ends."""
