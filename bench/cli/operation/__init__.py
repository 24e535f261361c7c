"""Commands that operate a bench: run, serve, stop, doctor, calibrate, queue, tokens.

They parse words and print answers; the work is done in other rooms.
"""
