"""Errors of the model lab. Each message says what was found, what is wanted and which trial would supply it."""

from compensator.errors import CompensatorError


class LabError(CompensatorError):
    """Base of the lab's errors."""


class UnusableDataError(LabError, ValueError):
    """Raised when recordings cannot be compared with any model.

    - no position, no effort channel, no motion
    - fewer usable rows than the model has parameters
    """


class NeverSlidesError(UnusableDataError):
    """Raised when the joint is pushed in every trial and never slides; the message says what that tells."""


class UnknownEffectError(LabError, KeyError):
    """Raised when an effect is not in the catalogue; the message lists near names."""

    def __str__(self) -> str:
        return str(self.args[0])


class NotApplicableError(LabError, ValueError):
    """Raised when an effect needs a channel or a condition that the recordings do not have."""


class EffectFailedError(NotApplicableError):
    """Raised when an effect of another package is broken; the message names the package."""
