"""Reports: sections of words, tables and figures, printed on a terminal or written as one HTML file."""

from bench.report.html import html_page, write_html
from bench.report.section import Bars, Figure, Line, Points, Section, Table, shades

__all__ = ["Bars", "Figure", "Line", "Points", "Section", "Table", "html_page", "shades", "write_html"]
