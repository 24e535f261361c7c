"""The ways on which frames come to the node: a python-can bus, an slcan adapter, a socketcand server."""
