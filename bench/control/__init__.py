"""The control loop: exchange with the drive, check every limit, record, stop, and end in power-off.

It knows drives and the clock, but neither the store nor the service.
"""
