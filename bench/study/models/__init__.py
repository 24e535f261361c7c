"""What the functions of `bench.study` answer: one definition for Python, REST, the command line and the client.

Plain data and nothing else: no lab, no store, so that a client or a command imports it at once.
"""
