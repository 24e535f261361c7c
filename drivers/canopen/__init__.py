"""CANopen drives with the CiA 402 profile.

Sources: CiA 301 (communication), CiA 402-2 and -3 (drives), CiA 303-2 (units), the EDS of the maxon EPOS4.
"""

import logging

# what the libraries log is raised here as an error; without a handler of its own Python would print it as well
for _name in ("can", "canopen"):
    logging.getLogger(_name).addHandler(logging.NullHandler())
