"""How fast the drivers are beside their libraries used barely: `make benchmark`. Not a test.

    python -m tests.drivers.rates [SECONDS]

SECONDS is how long the rates are to be kept, 60 where it is left out. Host and devices ask for real-time turns of the
processor, where the system grants them: see `tests.devices.turns`. A pseudo-terminal goes through the kernel's ordinary
threads all the same; on a busy machine its rows show that.
"""

import os
import sys

from tests.devices.turns import turns
from tests.drivers import serial_rates
from tests.drivers.canopen import rates as canopen
from tests.drivers.damiao import rates as damiao
from tests.drivers.dynamixel import rates as dynamixel
from tests.drivers.feetech import rates as feetech
from tests.drivers.moteus import rates as moteus
from tests.drivers.odrive import rates as odrive
from tests.drivers.rate_rows import heading
from tests.drivers.robstride import rates as robstride

if __name__ == "__main__":
    with turns():
        print(f"load of the machine before: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
        print(heading())
        serial_rates.report()
        for kind in (dynamixel, feetech, odrive, damiao, robstride, moteus):
            for line in kind.rows():
                print(line, flush=True)
        canopen.report(float(sys.argv[1]) if len(sys.argv) > 1 else 60.0)
        print(f"load of the machine after: {os.getloadavg()[0]:.1f}, the benchmark's own included")
