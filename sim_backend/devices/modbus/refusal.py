"""How a device turns a request down."""


class Refused(Exception):
    """Raised for a request that is answered with an exception code: 1 function, 2 address, 3 value."""

    def __init__(self, code: int) -> None:
        super().__init__(f"Modbus exception {code}")
        self.code = code


class Unanswered(Exception):
    """Raised for a request to which the device says nothing."""


ILLEGAL_FUNCTION, ILLEGAL_ADDRESS, ILLEGAL_VALUE = 1, 2, 3
