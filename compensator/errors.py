"""Errors of the compensator. Messages name the quantity, what was found, what is allowed and the unit."""


class CompensatorError(Exception):
    """Base of all errors of the compensator. Raised only through a subclass."""


class ModelParameterError(CompensatorError, ValueError):
    """Raised when a parameter breaks the law it belongs to (static friction below Coulomb, resistance of 0)."""


class NoEstimateError(CompensatorError, RuntimeError):
    """Raised when an estimate is asked of a search that has none; the message carries the search's reason."""


class CalibrationError(CompensatorError, ValueError):
    """Raised when measured points cannot give the parameters asked for (too few, one direction only, no low speed)."""


class LookupRangeError(CompensatorError, ValueError):
    """Raised when a look-up is asked too far outside what it was calibrated on."""


class SingularPoseError(CompensatorError, ArithmeticError):
    """Raised when a force is asked of joints that cannot tell it in their present pose."""
