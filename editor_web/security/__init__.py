"""Security of requests: access tokens, login sessions, request rules, and the ASGI middleware."""
