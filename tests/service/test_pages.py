"""Every list comes in pages, and the pages join without gap or double."""

import pytest


@pytest.fixture(scope="module")
def lists(service) -> list[str]:
    """Every list of the interface."""
    document = service.stranger.get("/openapi.json").json()
    found = []
    for path, item in document["paths"].items():
        schema = item.get("get", {}).get("responses", {}).get("200", {}).get("content", {}).get("application/json")
        if schema is not None and "{" not in path:
            name = schema["schema"]["$ref"].rpartition("/")[2]
            if "items" in document["components"]["schemas"][name]["properties"]:
                found.append(path.removeprefix("/api/v1"))
    return found


def test_every_list_is_paged(service, lists):
    assert {"/effects", "/experiment-kinds", "/challenges", "/studies", "/trials", "/audit"} <= set(lists)
    for path in lists:
        page = service.client.get(path, params={"limit": 1}).json()
        assert page["limit"] == 1, path
        assert page["offset"] == 0, path
        assert len(page["items"]) <= 1, path
        assert service.client.get(path, params={"limit": 0}).status_code == 422, path


@pytest.mark.parametrize("path", ["/effects", "/experiment-kinds"])
def test_pages_join(service, path):
    whole = service.stranger.get(path).json()
    assert whole["next_offset"] is None
    found, offset = [], 0
    while offset is not None:
        page = service.stranger.get(path, params={"limit": 7, "offset": offset}).json()
        assert len(page["items"]) <= 7
        found += page["items"]
        offset = page["next_offset"]
    assert found == whole["items"]
    assert service.stranger.get(path, params={"offset": 10_000}).json()["items"] == []
