"""Reports: sections of words, tables and figures, printed on a terminal or written as one HTML file."""

from bench.report.figure import Bars, Figure, Line, Points, shades
from bench.report.html import write_html
from bench.report.section import Section, Table

__all__ = ["Bars", "Figure", "Line", "Points", "Section", "Table", "shades", "write_html"]
