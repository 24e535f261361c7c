"""Effects of inertia, gravity, springs, free play and elasticity, one a file.

Physics only: columns, parameters and bounds; nothing is fitted or judged here.
"""
