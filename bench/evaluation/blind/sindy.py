"""Optimisers of pysindy (Kaptanoglu et al. 2022) on the columns of the lab; asked only where it is installed.

STLSQ   sequentially thresholded least squares (Brunton et al. 2016)
SR3     sparse relaxed regularised regression, L0 (Zheng et al. 2019)
"""

import warnings
from importlib.util import find_spec

import numpy as np

from compensator.lab.recordings.recording import FloatArray

OPTIMIZERS = ("STLSQ", "SR3")


def is_installed() -> bool:
    """Whether there is a pysindy to ask: `pip install friction-bench[bench]`."""
    return find_spec("pysindy") is not None


def coefficients_of(optimizer: str, columns: FloatArray, residual: FloatArray, threshold: float) -> FloatArray:
    """Sparse coefficients (k,) of unit-norm columns (n, k) for a residual (n,).

    Args:
        optimizer: one of OPTIMIZERS.
        columns: of unit norm.
        residual: to be explained.
        threshold: coefficients below it are none.
    """
    import pysindy  # takes seconds: only a benchmark pays for it

    made = {
        "STLSQ": lambda: pysindy.STLSQ(threshold=threshold, alpha=0.0),
        # of an L0 penalty: the prox keeps what is larger than sqrt(2 lambda nu)
        "SR3": lambda: pysindy.SR3(reg_weight_lam=0.5 * threshold**2, relax_coeff_nu=1.0, unbias=True),
    }[optimizer]()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that all coefficients are gone is an answer, too
        made.fit(columns, residual[:, None])
    found: FloatArray = np.nan_to_num(np.asarray(made.coef_, dtype=np.float64)[0])
    return found
