"""Builds of the package, and a slide that their kernels compute without Python."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

ROOT = Path(__file__).parents[2]


def build_wheel(folder: Path, *definitions: str) -> Path:
    """Builds a wheel as any user does, but stops at warnings; gives the build directory."""
    settings = [
        f"build-dir={folder / 'build'}",
        "cmake.define.CMAKE_EXPORT_COMPILE_COMMANDS=ON",
        "cmake.define.GIMPSLOPE_WARNINGS_AS_ERRORS=ON",
        *(f"cmake.define.{definition}" for definition in definitions),
    ]
    pip = [sys.executable, "-m", "pip", "wheel", "--no-deps", "--wheel-dir", folder, ROOT]
    subprocess.run([*pip, *(f"--config-settings={setting}" for setting in settings)], check=True)
    return folder / "build"


def compile_slide(build: Path, compiler: str, *options: str) -> Path:
    """The program of slide.cpp, with the kernel of a build."""
    program = build / "slide"
    sources = [Path(__file__).with_name("slide.cpp"), build / "libkernel.a"]
    flags = ["-std=c++20", "-pthread", f"-I{ROOT / 'cpp'}", *options]
    subprocess.run([compiler, *flags, *sources, "-o", program], check=True)
    return program


class Slide(NamedTuple):
    """What slide.cpp shows: the instruction set, and the fields of the points."""

    instruction_set: str
    fields: dict[str, NDArray[np.float64]]


def slide(*command: str | Path, instruction_set: str = "") -> Slide:
    """Runs slide.cpp: `command` is its program, or an emulator, its options and the program."""
    words = [*command, "1", "200", *instruction_set.split()]
    shown = subprocess.run(words, check=True, stdout=subprocess.PIPE, text=True).stdout
    name, *lines = shown.splitlines()
    fields = {field: np.array(values, float) for field, *values in map(str.split, lines)}
    return Slide(name, fields)


def assert_same_but_for_rounding(found: Slide, expected: Slide) -> None:
    """Soil that yields and slides magnifies the roundings of the first steps in those that follow;
    the bound is that of the unit tests between instruction sets."""
    for name, field in expected.fields.items():
        assert np.isfinite(field).all()
        bound = 1e-9 * np.abs(field).max()
        np.testing.assert_allclose(found.fields[name], field, rtol=0, atol=bound, err_msg=name)
