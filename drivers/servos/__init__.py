"""Servos with a table of items on a serial bus: what Dynamixel and Feetech share, whatever their frames and tables."""
