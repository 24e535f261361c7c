"""The walk through the page, as a new user goes it: nothing but its address and the token; then every view is opened.

Its pictures are those of `make screenshots`; WALK_PICTURES names a folder in which they are kept.
"""

import os
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from bench.service.routes import challenges
from tests.browser.screenshots import SCHEMES, SEED, SIZES, VIEWS, WORDS, take_views, take_walk
from tests.service.running_service import RunningService, running_service

pytestmark = pytest.mark.browser
MOST_CLICKS, MOST_S = 20, 480
STEPS = 11


@pytest.fixture
def fresh(tmp_path: Path) -> Iterator[RunningService]:
    """A service that nobody has used: its first study is the walk's, and its views show nothing else."""
    with running_service(tmp_path) as running:
        yield running


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return Path(os.environ.get("WALK_PICTURES") or tmp_path)


@pytest.mark.timeout(600)
def test_a_hidden_effect_is_explained_in_few_clicks(fresh, open_page, monkeypatch, folder):
    monkeypatch.setattr(challenges.secrets, "randbits", lambda _bits: SEED)
    begin_s = time.monotonic()
    page = open_page("", token=False, width=1440, service=fresh)
    page.set_default_timeout(200_000)
    walker = take_walk(page, folder)
    page.get_by_text("One mechanism was hidden, and the guess says just that.").wait_for()
    assert time.monotonic() - begin_s < MOST_S
    assert len(walker.clicks) <= MOST_CLICKS, walker.clicks
    assert len(list(folder.glob("walk-*.png"))) == STEPS
    assert (folder / WORDS).exists()
    page.close()
    taken = take_views(lambda width, height: open_page("", True, width, SCHEMES[0], height, fresh, True), folder)
    assert len(set(taken)) == len(VIEWS) * len(SIZES) * len(SCHEMES)
    assert [name for name in taken if not (folder / name).exists()] == []
