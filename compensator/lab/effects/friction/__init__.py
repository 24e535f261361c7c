"""Effects of friction, one a file.

Physics only: columns, parameters and bounds; nothing is fitted or judged here.
"""
