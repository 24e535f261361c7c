"""The walk of docs/tutorial/walk.md: what a new user does on the page, from its address to an explained effect."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from tests.service.running_service import TOKEN

Camera = Callable[[str], None]


@dataclass
class Walker:
    """A user who clicks, and counts it.

    Attributes:
        page: the browser's.
        shot: takes a picture of a step.
        clicks: what was pressed so far, in words.
    """

    page: Any
    shot: Camera
    clicks: list[str] = field(default_factory=list)

    def press(self, target: Any, words: str) -> None:
        """Click."""
        target.click()
        self.clicks.append(words)

    def link(self, name: str) -> None:
        """Follow a link of that name."""
        self.press(self.page.get_by_role("link", name=name).first, name)

    def button(self, name: str) -> None:
        """Press a button of that name."""
        self.press(self.page.get_by_role("button", name=name).first, name)


def watch_and_stop(walker: Walker) -> None:
    """Steps 1 and 2: token, a run, STOP."""
    page, shot = walker.page, walker.shot
    page.locator(".badge.idle").wait_for()
    shot("first-page")
    walker.link("Watch a run")
    page.get_by_label("Token: to start").fill(TOKEN)
    walker.button("Use token")
    page.get_by_text("Start moves the simulated joint").wait_for()
    shot("bench")
    walker.press(page.get_by_role("button", name="Start", exact=True), "Start")
    page.get_by_text("B breakaway").wait_for()
    shot("running")
    page.keyboard.press("Escape")
    page.get_by_text("Stop accepted and confirmed").wait_for()
    shot("stopped")


def explain_a_challenge(walker: Walker) -> str:
    """Steps 3 to 7. Returns the name of the effect that was added."""
    page, shot = walker.page, walker.shot
    walker.link("friction-bench")
    walker.link("Find a hidden effect")
    walker.button("New challenge")
    page.get_by_text("is ready. Make a study").wait_for()
    shot("challenge")
    walker.link("Study challenge")
    page.get_by_text("enough to fit a model").wait_for()
    shot("new-study")
    walker.button("Create study")
    page.locator("table.heat button.cell").first.wait_for()
    shot("compare")
    walker.press(page.locator("table.heat button.cell").first, "a cell of the error map")
    page.get_by_label("Moments").get_by_role("button").first.wait_for()
    walker.link("3 Diagnose")
    walker.button("Diagnose")
    first = page.locator("article").first
    first.locator("canvas.chart").wait_for()
    shot("diagnosis")
    named = str(first.get_attribute("aria-label"))
    walker.press(first.get_by_role("button", name="Add"), "Add")
    page.get_by_role("button", name="Undo this change").wait_for()
    page.locator(".study-head").get_by_text("the error falls from").wait_for()
    shot("error-before-and-after")
    walker.link("5 Result")
    page.locator(".plot.ladder .trace").first.wait_for()
    shot("result")
    walker.link("Learn")
    walker.button("Guess at challenge")
    page.get_by_label("or what a study").get_by_role("option").first.wait_for(state="attached")
    assert page.get_by_label("or what a study").input_value() != ""  # the study of the challenge is offered
    walker.button("Reveal")
    page.locator("main [role=status]").get_by_text("hidden").last.wait_for()
    page.locator("main [role=status]").last.scroll_into_view_if_needed()
    shot("revealed")
    return named
