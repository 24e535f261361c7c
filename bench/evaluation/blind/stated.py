"""Whether the intervals that a fit states of its parameters hold the truth."""

from collections.abc import Mapping

from scipy.stats import t as student

from compensator.lab.model.fitted import Fit
from compensator.lab.model.intervals import standard_errors

Parameter = tuple[str, str]
"""Effect and parameter, by their names."""


def confidences(fit: Fit, true: Mapping[Parameter, float]) -> tuple[float, ...]:
    """How much confidence the interval of each parameter takes to just reach the truth, 0..1, of those that are known.

    Of honest intervals all confidences are as likely as each other.

    Args:
        fit: of the model.
        true: values, in the unit of the fit's effort.
    """
    errors, count = standard_errors(fit)
    names = [(term.effect.name, parameter.name) for term in fit.terms for parameter in term.effect.parameters]
    known = zip(names, fit.coefficients.tolist(), errors.tolist(), strict=True)
    off = [abs(value - true[name]) / error for name, value, error in known if name in true and error > 0.0]
    return tuple(float(1.0 - 2.0 * student.sf(one, count - 1)) for one in off)
