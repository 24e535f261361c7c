"""Shells complete our commands, kinds of experiments and their parameters."""

import os
import subprocess
import sys

import pytest


def offered(words: str) -> set[str]:
    """What bash is told for the last word of a line."""
    line = f"friction-bench {words}"
    asked = {"_FRICTION_BENCH_COMPLETE": "complete_bash", "COMP_WORDS": line, "COMP_CWORD": str(line.count(" "))}
    command = [sys.executable, "-c", "import sys; sys.argv[0] = 'friction-bench'; from bench.cli import main; main()"]
    done = subprocess.run(command, env=os.environ | asked, stdout=subprocess.PIPE, text=True, timeout=60)
    return set(done.stdout.split())


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        ("que", {"queue"}),
        ("run chi", {"chirp"}),
        ("run chirp --high", {"--high-hz"}),
        ("token ", {"new", "revoke"}),
    ],
)
def test_the_shell_is_offered_what_may_follow(words, wanted):
    assert wanted <= offered(words)


def test_nothing_is_offered_that_does_not_begin_so():
    assert offered("que") == {"queue"}
