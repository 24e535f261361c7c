"""Parts that procedures are composed of, with `yield from`: moves, strokes, searches, signals, checks before motion.

They see readings and yield actions; they see no clock, no drive and no database.
"""
