"""The stream of status and rows to whoever watches, and what a listener missed.

It reads; it starts and stops nothing.
"""
