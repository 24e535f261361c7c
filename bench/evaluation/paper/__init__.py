"""Every figure and table of the paper, from trials of this bench, beside the paper's numbers."""

from bench.evaluation.paper.reproduction import reproduce, summary
from bench.evaluation.paper.row import Row

__all__ = ["Row", "reproduce", "summary"]
