"""The simulated drive in process: the drive contract on a plant, in virtual time.

It speaks no wire protocol; see `sim_backend.devices` for drives that do.
"""
