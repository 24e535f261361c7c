"""How the page and its files reach a browser."""

import gzip
import re

import httpx
import pytest

from bench.service.http import page


@pytest.fixture
def index(service):
    return httpx.get(service.url + "/").text


def test_everything_that_the_first_page_asks_for_is_small_and_kept_for_good(service, index):
    paths = sorted(set(re.findall(r'"(/static/[^"]+)"', index)))
    assert len(paths) > 50
    sent = 0
    with httpx.Client(base_url=service.url, headers={"Accept-Encoding": "gzip"}) as client:
        for path in paths:
            answer = client.get(path)
            assert answer.status_code == 200, path
            assert answer.headers["content-encoding"] == "gzip", path
            assert "immutable" in answer.headers["cache-control"], path
            sent += int(answer.headers["content-length"])
    assert sent < 700_000


def test_a_changed_file_has_another_address(service, index, monkeypatch, tmp_path):
    known = re.search(r"/static/(\w{12})/modules/app/main.js", index)[1]
    for path in page.WEB.rglob("*"):
        if path.is_file():
            copy = tmp_path / path.relative_to(page.WEB)
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(path.read_bytes())
    (tmp_path / "style.css").write_text("body {}")
    monkeypatch.setattr(page, "WEB", tmp_path)
    changed = httpx.get(service.url + "/").text
    assert known not in changed
    old = httpx.get(f"{service.url}/static/{known}/style.css")
    assert old.text == "body {}"
    assert old.headers["cache-control"] == "no-cache"


def test_plotly_is_compressed_too(service, index):
    known = re.search(r"/static/(\w{12})/", index)[1]
    assert "plotly.min.js" not in index  # asked for with the first plot that needs it
    with httpx.stream("GET", f"{service.url}/static/{known}/plotly.min.js") as answer:
        raw = b"".join(answer.iter_raw())
    assert len(raw) < 1_600_000
    assert gzip.decompress(raw) == page.plotly_file().read_bytes()


@pytest.mark.parametrize("fingerprint", ["", "000000000000/"])
@pytest.mark.parametrize(
    "path",
    ["modules/../../pyproject.toml", "modules/%2e%2e/%2e%2e/pyproject.toml", "..%2fpyproject.toml", "//etc/passwd",
     "modules/app", "modules/none.js", "%00", "modules\\..\\..\\pyproject.toml"],
)  # fmt: skip
def test_nothing_else_is_served(service, fingerprint, path):
    host, port = service.url.removeprefix("http://").split(":")
    import http.client

    connection = http.client.HTTPConnection(host, int(port))  # sends the path as it is
    connection.request("GET", f"/static/{fingerprint}{path}")
    assert connection.getresponse().status == 404
    connection.close()
