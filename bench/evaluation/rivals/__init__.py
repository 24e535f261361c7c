"""Ways to take friction out of a motor current, compared on the same recorded samples of the simulated bench."""

from bench.evaluation.rivals.comparison import compare
from bench.evaluation.rivals.tables import numbers_of, section_of

__all__ = ["compare", "numbers_of", "section_of"]
