"""The ladder plot: the name of each model stands within the picture, whatever its width."""

import pytest

from tests.service.recorded_joint import study_path

pytestmark = pytest.mark.browser


@pytest.mark.parametrize("width", [1440, 390])
def test_names_of_models_end_within_the_plot(open_page, service, width):
    path = study_path(service, f"ladder {width}")
    for effect in ("viscous_asymmetry", "position_periodic_friction"):
        service.client.post(f"{path}/models", json={"effect": effect}).raise_for_status()
    page = open_page(f"#study/{path.split('/')[-1]}/result", width=width)
    page.locator(".ladder .xtick").nth(2).wait_for()
    plot = page.locator(".ladder").bounding_box()
    for name in page.locator(".ladder .xtick").all():
        box = name.bounding_box()
        assert plot["x"] <= box["x"]
        assert box["x"] + box["width"] <= plot["x"] + plot["width"]
        assert box["y"] + box["height"] <= plot["y"] + plot["height"]


def test_it_keeps_to_its_card_when_its_step_is_opened_later(open_page, service):
    path = study_path(service, "ladder later")
    page = open_page(f"#study/{path.split('/')[-1]}/compare", width=1440)
    page.locator("table.heat button.cell").first.wait_for()
    page.get_by_role("link", name="5 Result").click()
    page.locator(".ladder .xtick").first.wait_for()
    card = page.locator(".panel", has=page.locator(".ladder")).last.bounding_box()
    drawing = page.locator(".ladder .main-svg").first.bounding_box()
    assert drawing["x"] + drawing["width"] <= card["x"] + card["width"]
    [model] = service.stranger.get(f"{path}/ladder").json()["rungs"]
    assert page.locator(".ladder .xtick").first.text_content() == f"{model['model_id']}:base"
