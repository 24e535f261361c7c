"""One study as one HTML file.

It shows what the other modules of `bench.study` answer; it computes nothing.
"""
