"""A fitted model under the control law that the joint ran under: does it go where the joint went."""
