"""Runs the fitter of a checkout of Rhoban/bam as it is: `python -m tests.recordings.bam_fitter CHECKOUT [its options]`.

It imports a web service's client at its head, which it uses on request only: an empty module stands for it.
"""

import runpy
import sys
import types


def main() -> None:
    """Hand the command line on."""
    sys.path.insert(0, sys.argv[1])
    sys.modules["wandb"] = types.ModuleType("wandb")
    sys.argv = ["bam.fit", *sys.argv[2:]]
    runpy.run_module("bam.fit", run_name="__main__")


if __name__ == "__main__":
    main()
