"""What comes from outside is shown, and does nothing to the terminal."""

import pytest

from bench.cli.output import complain, say, table

HOSTILE = "trial \x1b]0;owned\x07\x1b[2J of [bold]x[/bold]\r\x9b1m"


@pytest.mark.parametrize("show", [say, complain, lambda text: table(text, [text], [[text]])])
def test_control_signs_do_not_reach_the_terminal(capsys, show):
    show(HOSTILE)
    printed = "".join(capsys.readouterr())
    assert not set(printed) & set("\x1b\x07\r\x9b")
    assert "[bold]x[/bold]" in printed
