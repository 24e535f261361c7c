"""What the columns of an unknown file may be: a mapping from their names and values, and what has to be asked.

It proposes and says why; it keeps nothing. What is outside physics is a question, never an answer.
"""

from bench.recording_set.guess.assign import Said, read_said
from bench.recording_set.guess.guess import Guess, Known, Taken, guess_mapping, mapping_text
from bench.recording_set.guess.rig_template import rig_text
from bench.recording_set.guess.unknown import check_answered, guess_of, read_sheets, read_unknown

__all__ = [
    "Guess",
    "Known",
    "Said",
    "Taken",
    "check_answered",
    "guess_mapping",
    "guess_of",
    "mapping_text",
    "read_said",
    "read_sheets",
    "read_unknown",
    "rig_text",
]
