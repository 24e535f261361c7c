"""Ways to take friction out of a motor current, compared on the same recorded samples of the simulated bench."""

from bench.rivals.comparison import compare
from bench.rivals.tables import numbers_of, section_of

__all__ = ["compare", "numbers_of", "section_of"]
