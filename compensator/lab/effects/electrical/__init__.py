"""Effects of motor, power stage, supply and sensors, one a file.

Physics only: columns, parameters and bounds; nothing is fitted or judged here.
"""
