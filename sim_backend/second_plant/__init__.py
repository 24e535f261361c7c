"""A second simulated joint with its own physics, protocol and sensors, for judging the model lab on data it was not built on.

It is written from physics books alone: it imports nothing of this project, and nothing but the blind benchmark imports it.
"""
