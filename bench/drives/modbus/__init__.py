"""Drives on Modbus RTU and TCP, by their register maps."""
