"""Feetech STS servos on a serial bus."""
