"""How hosts reach a simulated device on a CAN bus: slcan, socketcand, any interface of python-can."""
