"""What holds for all tests: one thread for linear algebra, and Ctrl-C that is heard."""

import os
import signal

# the matrices are small, and waiting threads cost more than they save; read when numpy is imported
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# a shell that starts the tests in the background lets them, and every process of theirs, ignore Ctrl-C
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
