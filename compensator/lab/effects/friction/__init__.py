"""Effects of friction, by what it depends on.

Physics only: columns, parameters and bounds; nothing is fitted or judged here.
"""
