"""The drive contract and its errors; the real drives that satisfy it are to come."""
