"""Feetech STS servos, SCS protocol, as Feetech's protocol manual and memory table describe them."""
