"""Commands on what was recorded: store, experiments, trials, import and export.

They parse words and print answers; the work is done in other rooms.
"""
