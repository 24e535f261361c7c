"""The page's colours: told apart with any colour vision, and seen on their ground; light and dark."""

import re
from itertools import combinations

import numpy as np
import pytest

from bench.service.http.page import WEB

# linear RGB as seen without one kind of cone: Machado, Oliveira, Fernandes 2009, severity 1
VISION = {
    "protanopia": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "deuteranopia": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    "tritanopia": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
    "all cones": np.eye(3),
}
XYZ = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
)
# lines of one row: currents in the live plot, and up to four trials laid over each other
TOGETHER = [*combinations(("red", "purple", "sky"), 2), *combinations(("blue", "red", "green", "orange"), 2)]
LEAST_DIFFERENCE = 12.0  # in CIELAB; 2.3 is just noticeable side by side (Mahy 1994)
LEAST_CONTRAST = 3.0  # WCAG 2.2, 1.4.11
TEXT_CONTRAST = 4.5  # WCAG 2.2, 1.4.3


def schemes() -> dict[str, dict[str, np.ndarray]]:
    style = (WEB / "style.css").read_text()
    light, dark = re.findall(r":root \{(.*?)\}", style, flags=re.DOTALL)[:2]
    found = {}
    for name, text in (("light", light), ("dark", light + dark)):
        pairs = re.findall(r"--([a-z-]+): #([0-9a-f]{6});", text)
        found[name] = {one: linear(value) for one, value in pairs}
    return found


def linear(value: str) -> np.ndarray:
    parts = np.array([int(value[at : at + 2], 16) / 255.0 for at in (0, 2, 4)])
    return np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)


def lab(rgb: np.ndarray) -> np.ndarray:
    xyz = XYZ @ np.clip(rgb, 0.0, 1.0) / XYZ.sum(axis=1)
    x, y, z = np.where(xyz > 216 / 24389, np.cbrt(xyz), (24389 / 27 * xyz + 16) / 116)
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def contrast(one: np.ndarray, other: np.ndarray) -> float:
    low, high = sorted((float(XYZ[1] @ one), float(XYZ[1] @ other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("vision", VISION)
def test_lines_of_a_plot_are_told_apart(scheme, vision):
    colours = schemes()[scheme]
    seen = {name: lab(np.array(VISION[vision]) @ rgb) for name, rgb in colours.items()}
    apart = {pair: float(np.linalg.norm(seen[pair[0]] - seen[pair[1]])) for pair in TOGETHER}
    assert min(apart.values()) > LEAST_DIFFERENCE, apart


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_lines_and_text_stand_out_from_their_ground(scheme):
    colours = schemes()[scheme]
    for name, least in [
        *((one, LEAST_CONTRAST) for one in ("blue", "green", "red", "purple")),
        ("text", TEXT_CONTRAST),
        ("soft", TEXT_CONTRAST),
    ]:
        for ground in ("panel", "page"):
            assert contrast(colours[name], colours[ground]) >= least, (name, ground)


def test_the_check_sees_what_cannot_be_told_apart():
    red, green = (lab(np.array(VISION["deuteranopia"]) @ linear(value)) for value in ("a05a00", "5a7a00"))
    assert np.linalg.norm(red - green) < LEAST_DIFFERENCE
