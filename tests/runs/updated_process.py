"""A bench process whose software was updated while the service ran."""

import sys
from multiprocessing.connection import Connection


def main() -> None:
    Connection(int(sys.argv[1])).send_bytes(b"friction-bench bench process, 99")
