"""What the tests of the built package share: one build, for they take long."""

from __future__ import annotations

from pathlib import Path

import pytest
from package_build import build_wheel, compile_slide


@pytest.fixture(scope="session")
def alone(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build directory of a wheel without threads, for this processor and older ones."""
    return build_wheel(tmp_path_factory.mktemp("alone"), "GIMPSLOPE_THREADS=OFF")


@pytest.fixture(scope="session")
def native_slide(alone: Path) -> Path:
    """The slide of that build."""
    return compile_slide(alone, "c++")
