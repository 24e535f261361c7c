"""Experiments under way: one at a time, in a thread or in a process of its own, watched, stopped and recorded.

It starts what experiments define; it defines none itself.
"""
