"""What the README shows works as it stands there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import gimpslope as gs

README = Path(__file__).parents[2] / "README.md"


@pytest.mark.skipif(not README.exists(), reason="no source tree")
def test_scene_file(tmp_path: Path) -> None:
    (text,) = re.findall(r"```toml\n(.*?)```", README.read_text(), flags=re.DOTALL)
    (tmp_path / "scene.toml").write_text(text)
    setup = gs.load(tmp_path / "scene.toml")
    content = setup.scene.stones.area / setup.scene.outline.area
    assert content == pytest.approx(0.15, abs=0.004), "to one stone"
    assert setup.scene.stone == gs.Rigid(2400)
    assert setup.stages.slide.duration == 4 and setup.method.viscosity == 0.5625
