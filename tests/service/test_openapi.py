"""The interface's own description: good enough to use it alone."""

import json
import re

import httpx
import jsonschema_rs
import pytest
from fastapi import FastAPI
from pydantic import Field

from bench.evaluation.figures import trials as figures
from bench.evaluation.paper.measurements import Plan
from bench.experiments.registry import whole_parameters
from bench.service.http.openapi import install
from bench.study.models.base import EffortName, StudyModel
from compensator.lab.effects.catalogue import catalogue


@pytest.fixture(scope="module")
def document(service):
    return service.stranger.get("/openapi.json").json()


def test_every_route_is_described(document):
    for path, item in document["paths"].items():
        for method, route in item.items():
            assert route["summary"], (method, path)
            assert route["description"], (method, path)
            assert route["tags"], (method, path)


def test_every_change_asks_for_the_token_and_declares_its_refusal(document):
    for path, item in document["paths"].items():
        for method, route in item.items():
            if method != "get":
                assert route["security"] == [{"token": []}], (method, path)
                assert "401" in route["responses"], (method, path)


def answers(document):
    """(route, status, answer) of every answer that is no problem and has a body."""
    for path, item in document["paths"].items():
        for method, route in item.items():
            for status, answer in route["responses"].items():
                if status.startswith("2") and status != "204":
                    yield f"{method} {path}", status, answer


def test_every_answer_has_an_example(document):
    for route, status, answer in answers(document):
        for media_type, said in answer["content"].items():
            if said.get("schema", {}).get("format") == "binary":
                assert "attachment" in answer["headers"]["Content-Disposition"]["example"], (route, status)
            else:
                assert said.get("example") is not None, (route, status, media_type)


def test_examples_are_answers_as_they_are_now(document):
    """Where this fails after a change of an answer: python -m tests.service.make_examples."""
    tried = 0
    for route, _status, answer in answers(document):
        said = answer["content"].get("application/json")
        if said is not None:
            schema = {**said["schema"], "components": document["components"]}
            errors = [
                error.message for error in jsonschema_rs.Draft202012Validator(schema).iter_errors(said["example"])
            ]
            assert not errors, route
            fields = document["components"]["schemas"][said["schema"]["$ref"].rpartition("/")[2]]["properties"]
            assert set(said["example"]) == set(fields), route
            tried += 1
    assert tried > 50


class Largest(StudyModel):
    trial_id: int = Field(examples=[7])
    effort: EffortName = Field(description="what it is of")


class AllOfThem(StudyModel):
    items: list[Largest]
    floor: float | None


class Nameless(StudyModel):
    items: list[Largest]
    count: int


def test_an_answer_that_was_not_recorded_is_shown_by_the_examples_of_its_fields():
    app = FastAPI()
    for path, model in (("/whole", AllOfThem), ("/nameless", Nameless)):
        app.get(path, response_model=model)(lambda: None)
    install(app)
    said = {route: answer["content"]["application/json"] for route, _, answer in answers(app.openapi())}
    largest = {"trial_id": 7, "effort": {"name": "torque", "unit": "N m"}}
    assert said["get /whole"]["example"] == {"items": [largest], "floor": None}
    assert "example" not in said["get /nameless"]  # a field of it has none: `test_every_answer_has_an_example` says so


def test_every_property_name_or_text_says_its_unit(document):
    text = json.dumps(document["components"]["schemas"])
    for name in ("watchdog_s", "max_rate_hz", "position_rad", "load_kg"):
        assert name in text


def test_the_order_of_use_is_in_the_text(document):
    for path in ("/api/v1/experiments", "/api/v1/live", "/api/v1/stop", "/api/v1/studies"):
        assert path in document["info"]["description"]


def test_the_page_and_its_files_are_served(service):
    page = httpx.get(service.url)
    assert page.headers["content-type"].startswith("text/html")
    for part in ("/static/style.css", "/static/plots.css", "/static/modules/app/main.js"):
        assert part in re.sub(r"/static/\w{12}/", "/static/", page.text)
        assert httpx.get(service.url + part, timeout=60.0).status_code == 200
    plotly = httpx.get(service.url + "/static/plotly.min.js")
    assert plotly.headers["content-type"].startswith("text/javascript")
    assert "plotly.js" in plotly.text[:200]
    assert httpx.get(service.url + "/static/../../pyproject.toml").status_code == 404
    assert "<script>" not in page.text
    assert "style=" not in page.text


def test_examples_name_effects_that_exist(document):
    schemas = document["components"]["schemas"]
    named = [example["effect"] for example in schemas["Change"]["examples"]]
    named += schemas["Effect"]["properties"]["name"]["examples"]
    named += re.findall(r'"effect": "(\w+)"', document["info"]["description"])
    assert len(named) == 3
    assert set(named) <= set(catalogue())


PAPER = {**Plan().measurements(), **figures.TRIALS, "drawn": figures.drawn_loads(1), "short": figures.SHORT}
PAPER |= {f"calibration {place}": one for place, one in enumerate((figures.CURVES, figures.AT_REST))}


@pytest.mark.parametrize("name", PAPER)
def test_what_the_page_of_the_paper_and_the_figures_are_made_of_can_be_started_over_rest(service, document, name):
    (path,) = (path for path in document["paths"] if path.endswith("/experiments"))
    body = document["paths"][path]["post"]["requestBody"]["content"]["application/json"]["schema"]
    schema = document["components"]["schemas"][body["$ref"].rsplit("/", 1)[-1]]
    assert {"kind", "parameters"} <= set(schema["properties"])
    kinds = {kind["name"]: kind for kind in service.stranger.get("/experiment-kinds").json()["items"]}
    wanted = PAPER[name]
    parameters = json.loads(json.dumps(whole_parameters(wanted.kind, wanted.parameters)))
    assert set(parameters) <= set(kinds[wanted.kind]["parameters"]["properties"])
    jsonschema_rs.validator_for(kinds[wanted.kind]["parameters"]).validate(parameters)
    with pytest.raises(jsonschema_rs.ValidationError):
        jsonschema_rs.validator_for(kinds[wanted.kind]["parameters"]).validate({**parameters, "loads": "some"})
