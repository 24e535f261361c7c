"""Goes through a commissioning on the page, as the person at the bench does."""

from collections.abc import Iterator
from typing import Any

ANSWERS = {
    "arm_length_m": "0.25", "gear_ratio": "50", "counts_per_turn": "", "motor_current_a": "3", "load_kg": "0.1",
    "hand_angle_deg": "90", "first_load_kg": "0.05",
}  # fmt: skip
SHOWN = "[data-question], .good, main .problem[role=alert]"


def walked(page: Any) -> Iterator[str]:
    """Begin, and answer each question; between them the key of the question that is shown, at the end the outcome."""
    page.get_by_role("button", name="Begin").click()
    while True:
        page.locator(f"main :is({SHOWN})").first.wait_for()
        question = page.locator("[data-question]")
        if not question.count():
            yield "end"
            return
        key = question.get_attribute("data-question")
        yield key
        answer(page, key)
        page.locator(f"[data-question={key}]").wait_for(state="detached")


def answer(page: Any, key: str) -> None:
    """Answer the question that is shown."""
    if key not in ANSWERS:
        page.get_by_role("button", name="Done").click()
    elif ANSWERS[key]:
        page.locator("#answer").fill(ANSWERS[key])
        page.get_by_role("button", name="Answer").click()
    else:
        page.get_by_role("button", name="Not known").click()
