"""The figures that the compensator is to reach, measured on the simulated bench: over seeds, and over rigs."""

from bench.evaluation.figures.measure import measure_figures
from bench.evaluation.figures.table import FigureRow, figures_table

__all__ = ["FigureRow", "figures_table", "measure_figures"]
