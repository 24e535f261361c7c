"""The figures that the compensator is to reach, measured on the simulated bench: over seeds, and over rigs."""

from bench.figures.measure import measure_figures
from bench.figures.table import FigureRow, figures_table

__all__ = ["FigureRow", "figures_table", "measure_figures"]
