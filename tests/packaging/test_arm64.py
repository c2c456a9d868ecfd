"""The package compiles for arm64 without warnings, and its kernel computes the same there."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from package_build import assert_same_but_for_rounding, build_wheel, compile_slide, slide

COMPILER = "aarch64-linux-gnu-g++"

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        shutil.which(COMPILER) is None,
        reason=f"needs the cross compiler {COMPILER} (Debian: g++-aarch64-linux-gnu)",
    ),
]


@pytest.fixture(scope="module")
def arm64(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build_wheel(
        tmp_path_factory.mktemp("arm64"),
        "CMAKE_SYSTEM_NAME=Linux",
        "CMAKE_SYSTEM_PROCESSOR=aarch64",
        f"CMAKE_CXX_COMPILER={COMPILER}",
    )


def test_compiles_without_warnings(arm64: Path) -> None:
    (module,) = arm64.glob("_core*.so")
    machine = module.read_bytes()[18:20]
    assert int.from_bytes(machine, "little") == 183  # EM_AARCH64 of the ELF header


def test_same_but_for_rounding(arm64: Path, native_slide: Path) -> None:
    emulator = shutil.which("qemu-aarch64-static") or shutil.which("qemu-aarch64")
    if emulator is None:
        pytest.skip("needs an emulator of arm64, qemu-aarch64 (Debian: qemu-user-static)")
    found = slide(emulator, compile_slide(arm64, COMPILER, "-static"))
    assert found.instruction_set == "generic"
    assert_same_but_for_rounding(found, slide(native_slide, instruction_set="generic"))
