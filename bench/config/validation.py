"""What pydantic found wrong, in words that name the place, the key, the value, what is allowed and the unit."""

from collections.abc import Iterable, Iterator
from difflib import get_close_matches
from typing import Annotated, Any, Union, get_args

from pydantic import BaseModel, Discriminator, Tag, ValidationError

from bench.config.quantities import unit_of

_SHOWN_CHARACTERS = 60
_TAGGED = "tagged-"  # begins the name of a branch of a union in a location


def problems(error: ValidationError, prefix: str = "", model: type[BaseModel] | None = None) -> list[str]:
    """One line per problem.

    Args:
        error: as pydantic raised it.
        prefix: put before each key ("limits").
        model: what was read; with it, the keys that are allowed stand beside one that is not.
    """
    return [_problem(detail, prefix, model) for detail in error.errors(include_url=False)]


def _problem(detail: Any, prefix: str, model: type[BaseModel] | None) -> str:
    location = [part for part in detail["loc"] if not _is_tag(part)]
    key = ".".join(str(part) for part in ([prefix] if prefix else []) + location) or "the whole"
    name = str(location[-1]) if location else ""
    unit = unit_of(name)
    if detail["type"] == "extra_forbidden":
        return f"{key}: {unknown_key(name, keys_beside(model, detail['loc']) if model is not None else [])}"
    if detail["type"] == "missing":
        return f"{key}: missing; give a value{f' in {unit}' if unit else ''}"
    wanted = detail["msg"].removeprefix("Value error, ").removeprefix("Input ")
    wanted = wanted[0].lower() + wanted[1:]
    if unit and detail["type"] != "value_error":
        wanted = f"{wanted} {unit}" if detail["type"].startswith(("greater", "less")) else f"{wanted}, in {unit}"
    return f"{key}: found {_shown(detail.get('input'))}; {wanted}"


def unknown_key(name: str, allowed: list[str]) -> str:
    """What is said of an unknown key: the allowed one that is spelled most like it, and all of them."""
    near = get_close_matches(name, allowed, 1)
    advice = f"did you mean '{near[0]}'?" if near else "remove it or correct its spelling"
    return f"unknown key; {advice} (allowed: {', '.join(allowed)})" if allowed else f"unknown key; {advice}"


def keys_beside(model: type[BaseModel], location: tuple[int | str, ...]) -> list[str]:
    """The keys beside an unknown one; none where several shapes are possible there."""
    here: list[Any] = [model]
    for part in location[:-1]:
        here = [one for outer in here for one in _inside(outer, part)] or here  # an index leads no deeper
    models = [one for annotation in here for one in models_in(annotation)]
    return [field.alias or name for name, field in models[0].model_fields.items()] if len(models) == 1 else []


def _inside(annotation: Any, part: int | str) -> Iterator[Any]:
    """Where a part of a location leads: to a field, or to the branch of a union that has this tag."""
    if _has_tag(annotation, part):
        yield annotation
    elif isinstance(part, str) and part.startswith(_TAGGED):
        for inner in get_args(annotation):
            yield from _inside(inner, part)
    else:
        for model in models_in(annotation):
            yield from (field.annotation for name, field in model.model_fields.items() if part in (name, field.alias))


def _has_tag(annotation: Any, tag: int | str) -> bool:
    return any(isinstance(one, Tag) and one.tag == tag for one in getattr(annotation, "__metadata__", ()))


def models_in(annotation: Any) -> Iterator[type[BaseModel]]:
    """The models that a field can hold, in a list or a dictionary, too."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for inner in get_args(annotation):
        yield from models_in(inner)


def _is_tag(part: Any) -> bool:
    """Whether a part of a location is pydantic's own, such as the name of a union's branch."""
    return isinstance(part, str) and (part.startswith(("function-", _TAGGED)) or "[" in part)


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= _SHOWN_CHARACTERS else f"{text[:_SHOWN_CHARACTERS]}..."


def kind_of(model: type[BaseModel]) -> str:
    """The one word that `kind` of a model may be."""
    word: str = get_args(model.model_fields["kind"].annotation)[0]
    return word


def chosen_by_kind(models: Iterable[type[BaseModel]], refusal: str, default: str = "") -> Any:
    """The type of a section that is one of some models, by its `kind`; messages name its keys without the branch.

    Args:
        models: each has a `kind` of one word.
        refusal: what is said of any other.
        default: kind of a section that does not say.
    """

    def tag(section: Any) -> str:
        kind = section.get("kind", default) if isinstance(section, dict) else getattr(section, "kind", "")
        return f"{_TAGGED}{kind}"

    branches = tuple(Annotated[model, Tag(f"{_TAGGED}{kind_of(model)}")] for model in models)
    chosen = Discriminator(tag, custom_error_type="kind", custom_error_message=refusal)
    return Annotated[Union[branches], chosen]  # noqa: UP007  made of a list
