"""The wire between a process and its worker processes: framed messages, numbered requests, a child process.

Imports nothing of robots; planning, sim and vision use it. Messages are frozen data (msgspec structs and dataclasses)
that may hold float64 arrays; `message_codec` is the only place that turns them into bytes.
"""
