"""What stands round the joint: end stops, walls, and the hand of an operator.

It acts on the arm as forces; it never sets the state.
"""
