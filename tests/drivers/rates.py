"""How fast the drivers are beside their libraries used barely: `make benchmark`. Not a test.

    python -m tests.drivers.rates [SECONDS]

SECONDS is how long the rates are to be kept, 60 where it is left out.
"""

import sys

from tests.drivers import serial_rates
from tests.drivers.canopen import rates as canopen

if __name__ == "__main__":
    serial_rates.report()
    canopen.report(float(sys.argv[1]) if len(sys.argv) > 1 else 60.0)
