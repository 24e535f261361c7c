"""The kinds of drive that come with the package, one folder each: settings, how the driver is made, simulated device.

A kind is an entry point `friction_bench.drives`; it knows no other kind, and nothing of control loop, store or service.
"""
