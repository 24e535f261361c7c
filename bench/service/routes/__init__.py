"""The routes of the REST interface, one noun a file.

A route checks, calls one function of another room, and answers with a model; it computes nothing.
"""
