"""The atlas as a command, as a page and as data; the limits that theory gives of a step."""

from __future__ import annotations

import json
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from gimpslope import cli
from gimpslope.studies import page, stability
from gimpslope.studies.stability import amplification, rows, spin
from gimpslope.studies.stability.point_bound import bound
from gimpslope.studies.verify import Check


class Balanced(HTMLParser):
    """Which tags a page has, each closed that was opened."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.seen: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.seen.append(tag)
        if tag not in ("meta", "img"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def test_command_writes_the_atlas(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["stability", "spin", "apex", "--quick", "--output", str(tmp_path)]) == 0
    written = {path.name for path in tmp_path.iterdir()}
    assert written == {"atlas.md", "atlas.html", "atlas.json", "spin.png", "apex.png"}
    told = json.loads((tmp_path / "atlas.json").read_text())
    assert [mode["name"] for mode in told["modes"]] == ["spin", "apex"]
    assert all(mode["holds"] and mode["fails"] and mode["stands"] for mode in told["modes"])
    text = (tmp_path / "atlas.md").read_text()
    html = (tmp_path / "atlas.html").read_text()
    for name in ("spin", "apex"):
        mode = stability.mode(name)
        assert f"## {mode.title}" in text and mode.advice in text and f"{name}.png" in text
        assert f'id="{name}"' in html
    page_of = Balanced(html)
    assert page_of.open == [] and page_of.seen.count("img") == 2
    count = sum(len(mode["fails"]) + len(mode["stands"]) for mode in told["modes"])
    assert f"{count} of {count} checks hold" in capsys.readouterr().out


def test_command_fails_where_a_check_does(monkeypatch: pytest.MonkeyPatch) -> None:
    check = Check.at_most("error", bound=1.0, got=2.0, why="one is enough")
    wrong = replace(spin.MODE, run=lambda full: stability.Findings([check], [], Figure()))
    monkeypatch.setattr(spin, "MODE", wrong)
    assert cli.main(["stability", "spin"]) == 1


def test_command_refuses_unknown_modes(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["stability", "spin", "gravity"]) == 2
    assert "mode must be one of step_limit, " in capsys.readouterr().err


def test_page_escapes() -> None:
    blocks = [page.Grid(["a|b"], [["`x < 1`"]]), page.Paragraph("1 & 2", begins="So")]
    assert r"a\|b" in page.markdown(blocks)
    html = page.html("<t>", blocks)
    assert "<code>x &lt; 1</code>" in html
    assert "<em>So:</em> 1 &amp; 2" in html and "<title>&lt;t&gt;</title>" in html


def test_bound_by_the_stiffest_point() -> None:
    """Published: 0.544 for 2 x 2 points and nu = 0.33; in a row of domains that fill it, a point at
    the edge of its reach alone has G^2 / S = 1 / (h l), the bound cannot be above that."""
    assert bound("ugimp", 2, 0.33, 2) == pytest.approx(0.544, abs=5e-4)
    assert bound("ugimp", 2, 0.0, 1) < 2 / np.sqrt(4.0)


@pytest.mark.parametrize(("scheme", "limit"), [("usf", 3**0.5), ("musl", 3**0.5)])
def test_limit_of_a_long_row(scheme: str, limit: float) -> None:
    """Points a quarter of a cell from the nodes average velocities by W = (5 + 3 cos theta) / 8,
    and C^2 W sin^2(theta / 2) is 1/3 C^2 at most: sqrt(3)."""
    x = np.arange(40) / 2 + 0.25
    values, slopes = rows.along("ugimp", x, np.full_like(x, 0.25))
    assert amplification.limit(values, slopes, scheme) == pytest.approx(limit, rel=0.015)
