"""Who may do what: tokens, roles, wrong attempts, TLS, and the audit trail.

Nothing here moves a joint; STOP must never wait for it.
"""
