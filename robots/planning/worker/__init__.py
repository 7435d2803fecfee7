"""Who answers planning requests: in this process under virtual time, else in a process of its own.

Others enter by `plan_service`; what is asked and answered is `robots.planning.request`.
"""
