"""The REST interface, from the OpenAPI document of the service."""

import json
import tempfile
from collections import defaultdict
from collections.abc import Iterator
from typing import Any

from bench.config.configuration import default_configuration
from bench.own_service import LOOPBACK_NAMES
from bench.runs.runner import Runner
from bench.service.app import create_app
from bench.service.auth.access import Access
from bench.service.auth.token_register import TokenRegister
from bench.store import Store
from docs.generate.markdown import anchor, code, folded, table
from docs.generate.schema import Schema, allowed, keys

FOLDER = "rest"
Route = tuple[str, str, Schema]
BEGIN = """\
# REST interface

The service describes itself: `GET /api/v1/openapi.json`. These pages are written from that description.
"""
MODELS = """\
# Models of the REST interface

What bodies and answers are made of. Names carry their units; what was not measured is `null`.

"""


def document() -> Schema:
    """The OpenAPI document of a service that is never started."""
    with tempfile.TemporaryDirectory() as folder, Store.open(f"sqlite:///{folder}/empty.sqlite") as store:
        access = Access(TokenRegister({}, store.access.tokens.find), reads_open=True, hosts=LOOPBACK_NAMES)
        found: Schema = create_app(store, Runner(default_configuration(), store), access).openapi()
    return found


def pages() -> dict[str, str]:
    """Every page by its file: an index, one for each subject, the models."""
    described = document()
    by_tag: dict[str, list[Route]] = defaultdict(list)
    for path, item in described["paths"].items():
        for method, route in item.items():
            by_tag[route["tags"][0]].append((method.upper(), path, route))
    files = {tag: tag.replace(" ", "-") for tag in sorted(by_tag)}
    found = {f"{FOLDER}/{files[tag]}.md": _subject(tag, routes) for tag, routes in by_tag.items()}
    found[f"{FOLDER}/models.md"] = MODELS + "\n".join(_models(described["components"]["schemas"]))
    found[f"{FOLDER}/index.md"] = _index(described, by_tag, files)
    return found


def _index(described: Schema, by_tag: dict[str, list[Route]], files: dict[str, str]) -> str:
    rows = [
        (f"[{code(f'{method} {path}')}]({files[tag]}.md#{_slug(method, path)})", route["summary"])
        for tag in files
        for method, path, route in by_tag[tag]
    ]
    listed = "\n".join(["```{toctree}", ":hidden:", "", *files.values(), "models", "```"])
    return f"{BEGIN}\n{described['info']['description']}\n\n{table(('route', 'what it does'), rows)}\n{listed}\n"


def _slug(method: str, path: str) -> str:
    return f"{method}{path}".lower().translate(str.maketrans("/_{}", "--  ")).replace(" ", "")


def _subject(tag: str, routes: list[Route]) -> str:
    return f"# REST: {tag}\n\n" + "\n".join(_route(*one) for one in routes)


def _route(method: str, path: str, route: Schema) -> str:
    """One route: what it does, what it takes, what it answers."""
    token = "Takes a token.\n" if route.get("security") and method != "GET" else ""
    parts = [
        f"{anchor(_slug(method, path))}\n## `{method} {path}`\n",
        f"**{route['summary']}.** {route['description']}\n",
        token,
        _parameters(route.get("parameters", [])),
        _body(route.get("requestBody", {})),
        *_answers(route["responses"]),
    ]
    return "\n".join(filter(None, parts))


def _parameters(found: list[Schema]) -> str:
    if not found:
        return ""
    rows = [(code(one["name"]), one["in"], allowed(one["schema"], _link), one.get("description", "")) for one in found]
    return table(("parameter", "in", "allowed", "meaning"), rows)


def _body(body: Schema) -> str:
    kinds = ", ".join(f"{allowed(one.get('schema', {}), _link)} ({code(media)})" for media, one in _media(body))
    return f"Body: {kinds}\n" if kinds else ""


def _answers(responses: Schema) -> Iterator[str]:
    """What is answered: the good ones with their example, the problems as one line."""
    for status, answer in responses.items():
        if not status.startswith("2"):
            continue
        kinds = ", ".join(f"{allowed(one.get('schema', {}), _link)} ({code(media)})" for media, one in _media(answer))
        yield f"Answers {status}: {kinds or 'no body'}\n"
        for _, one in _media(answer):
            if "example" in one:
                yield folded("Example", "json", json.dumps(one["example"], indent=2, ensure_ascii=False))
    problems = [f"{status} {answer['description']}" for status, answer in sorted(responses.items()) if status >= "300"]
    yield "Otherwise: " + "; ".join(problems) + ".\n"


def _link(model: str) -> str:
    return f"[{code(_short(model))}](#{_place(model)})"


def _place(model: str) -> str:
    return "rest-model-" + "-".join(filter(None, model.lower().split("_")))


def _short(model: str) -> str:
    """The name of a model without that of its module, which FastAPI puts before names that come twice."""
    return model.rpartition("__")[2]


def _media(holder: Schema) -> list[tuple[str, dict[str, Any]]]:
    return list(holder.get("content", {}).items())


def _models(schemas: Schema) -> Iterator[str]:
    for name, schema in sorted(schemas.items()):
        values = keys(schema, _link) if "properties" in schema else allowed(schema, _link)
        yield f"{anchor(_place(name))}\n## {code(_short(name))}\n\n{schema.get('description', '')}\n\n{values}\n"
