"""The drive contract, its errors, and the real drives that satisfy it."""
