"""What comes from outside is shown, and does nothing to the terminal."""

import pytest

from bench.cli.output import complain, say, table, text

COMMAND = "friction-bench import " + " ".join(f"long-name-{number}.csv" for number in range(20)) + " --mapping m.toml"
HOSTILE = "trial \x1b]0;owned\x07\x1b[2J of [bold]x[/bold]\r\x9b1m"


@pytest.mark.parametrize("show", [say, complain, lambda text: table(text, [text], [[text]])])
def test_control_signs_do_not_reach_the_terminal(capsys, show):
    show(HOSTILE)
    printed = "".join(capsys.readouterr())
    assert not set(printed) & set("\x1b\x07\r\x9b")
    assert "[bold]x[/bold]" in printed


@pytest.mark.parametrize("terminal", [True, False])
def test_a_command_is_printed_on_one_line(capsys, monkeypatch, terminal):
    monkeypatch.setenv("COLUMNS", "80")
    if terminal:
        monkeypatch.setenv("FORCE_COLOR", "1")
    say(f"then: {COMMAND}")
    say("word " * 100)
    first, *others = capsys.readouterr().out.splitlines()
    assert first.strip() == f"then: {COMMAND}"
    assert len(others) == (7 if terminal else 3)


def test_numbers_in_lists_are_as_short_as_others():
    assert text([[1.0, 0.9149999999999999], [-1, None], []]) == "[[1, 0.915], [-1, -], []]"
