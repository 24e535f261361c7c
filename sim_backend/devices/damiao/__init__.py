"""A Damiao actuator on a CAN bus, MIT protocol, as Damiao's manuals describe it."""
