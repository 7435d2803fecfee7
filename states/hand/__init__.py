"""States of a hand that closes with one motor."""
