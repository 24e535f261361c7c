"""One thread for linear algebra: the matrices are small, and waiting threads cost more than they save."""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # read when numpy is imported
