"""A second simulated joint, for judging the model lab on data that it was not built on.

It is written from physics books alone and imports nothing of this project; nothing but the blind benchmark imports it.
"""
