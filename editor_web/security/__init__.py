"""Admission of requests: tokens, log-in sessions.

Request rules and the ASGI middleware in front of the application.
"""
