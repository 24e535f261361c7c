"""The simulated drive in this process: plant, virtual time, faults on a time table."""
