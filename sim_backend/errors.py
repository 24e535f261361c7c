"""Errors of the simulation's own making. What a drive would raise is in `drivers.errors`."""


class SimulationError(Exception):
    """Base of all errors of this package. Raised only through a subclass."""


class ParameterError(SimulationError, ValueError):
    """Raised when a plant is described that cannot exist, or cannot be integrated.

    - a value outside what the law allows; the message says parameter, value, unit and law
    - an unknown component, parameter or preset; the message lists the known ones
    - an integration step too coarse for the stiffest contact
    """
