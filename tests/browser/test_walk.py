"""The walk through the page, as a new user goes it: nothing but its address and the token."""

import time

import pytest

from bench.service.routes import challenges
from tests.browser.walk import Walker, explain_a_challenge, watch_and_stop

pytestmark = pytest.mark.browser
SEED = 13  # of the challenge; another one hides something else, or nothing
MOST_CLICKS, MOST_S = 20, 480


@pytest.mark.timeout(600)
def test_a_hidden_effect_is_explained_in_few_clicks(open_page, monkeypatch, tmp_path):
    monkeypatch.setattr(challenges.secrets, "randbits", lambda _bits: SEED)
    page = open_page("", token=False, width=1440)
    page.set_default_timeout(200_000)
    begin_s = time.monotonic()
    walker = Walker(page, lambda name: page.screenshot(path=tmp_path / f"{name}.png"))
    watch_and_stop(walker)
    explain_a_challenge(walker)
    page.get_by_text("One mechanism was hidden, and the guess says just that.").wait_for()
    assert time.monotonic() - begin_s < MOST_S
    assert len(walker.clicks) <= MOST_CLICKS, walker.clicks
    assert len(list(tmp_path.glob("*.png"))) == 11
