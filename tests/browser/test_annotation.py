"""Note and tags of an experiment, changed afterwards; found again by its tag."""

import re

import pytest

from tests.browser.browser import intercept

pytestmark = pytest.mark.browser


def test_an_experiment_is_tagged_afterwards_and_found_by_its_tag(service, open_page):
    plain, wanted = (service.run("steps", repeats=1)["experiment_id"] for _ in range(2))
    page = open_page("#trials")
    page.get_by_role("button", name=f"Edit note and tags of experiment {wanted}", exact=True).click()
    page.get_by_label("Note", exact=True).fill("after regreasing")
    page.get_by_label("Tags", exact=True).fill(f"winter, new grease, winter, set {wanted}")
    page.keyboard.press("Enter")
    edit = page.get_by_role("button", name=f"Edit note and tags of experiment {wanted}", exact=True)
    edit.wait_for()
    assert "Edit note" in page.evaluate("document.activeElement.getAttribute('aria-label')")
    kept = service.client.get(f"/experiments/{wanted}").json()
    assert (kept["note"], set(kept["tags"])) == ("after regreasing", {"winter", "new grease", f"set {wanted}"})

    page.get_by_label("Tag", exact=True).fill(f"set {wanted}")
    page.keyboard.press("Enter")
    page.get_by_role("button", name=f"Trials of experiment {plain}", exact=True).wait_for(state="detached")
    assert page.locator("[aria-label='Experiments'] tbody tr").count() == 1
    page.get_by_label("Tag", exact=True).fill("nobody's")
    page.keyboard.press("Enter")
    page.get_by_text("No experiment has the tag 'nobody's'.").wait_for()


def test_what_is_refused_stands_beneath_it_and_nothing_is_lost(service, open_page):
    experiment = service.run("steps", repeats=1)["experiment_id"]
    page = open_page("#trials")
    page.get_by_role("button", name=f"Edit note and tags of experiment {experiment}", exact=True).click()
    page.get_by_label("Tags", exact=True).fill("x" * 500)
    page.get_by_role("button", name="Save").click()
    page.locator(".annotation .problem").get_by_text(re.compile("tags")).wait_for()
    assert page.get_by_label("Tags", exact=True).input_value() == "x" * 500
    page.get_by_role("button", name="Cancel").click()
    assert service.client.get(f"/experiments/{experiment}").json()["tags"] == []
    open_page.expected.append("422")


def test_older_experiments_are_a_page_away(service, open_page):
    newest = service.run("steps", repeats=1)["experiment_id"]
    page = open_page("#bench")
    intercept(
        page,
        re.compile(r"/experiments\?.*limit=10$"),
        lambda route: route.continue_(url=route.request.url.replace("limit=10", "limit=1")),
    )
    page.get_by_role("link", name="Trials").click()
    page.get_by_role("button", name=f"Trials of experiment {newest}", exact=True).wait_for()
    page.get_by_role("button", name="Older").click()
    page.get_by_role("button", name=f"Trials of experiment {newest}", exact=True).wait_for(state="detached")
    page.get_by_role("button", name="Newer").click()
    page.get_by_role("button", name=f"Trials of experiment {newest}", exact=True).wait_for()
