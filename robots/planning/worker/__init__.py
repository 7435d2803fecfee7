"""The planning services: inline under virtual time, else in a separate process.

The entry point for other packages is `plan_service`; requests and answers are in `robots.planning.request`.
"""
