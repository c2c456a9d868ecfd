"""A shape function is added as CONTRIBUTING.md says, with the very code that stands there."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pybind11
import pytest

ROOT = Path(__file__).parents[2]
CHECKS = Path(__file__).with_name("cubic_bspline.py")


def blocks() -> dict[str, str]:
    """The code of the section by its language."""
    section = (ROOT / "CONTRIBUTING.md").read_text().split("## Adding a shape function\n")[1]
    return dict(re.findall(r"```(\w+)\n(.*?)```", section.split("\n## ")[0], re.DOTALL))


def changed(text: str, diff: str) -> str:
    """The text after a diff whose hunks are set apart by lines of @@."""
    for hunk in diff.split("@@\n"):
        lines = hunk.splitlines(keepends=True)
        before = "".join(line[1:] for line in lines if line[0] != "+")
        assert text.count(before) == 1
        text = text.replace(before, "".join(line[1:] for line in lines if line[0] != "-"))
    return text


def run(*command: str | Path, **variables: str) -> str:
    """What a command shows; it must succeed."""
    done = subprocess.run(
        command,
        env=os.environ | variables,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    assert done.returncode == 0, done.stdout
    return done.stdout


def install(source: Path, build: Path, site: Path) -> None:
    """Build the kernel for any processor and put it beside the Python package."""
    path = os.pathsep.join([sysconfig.get_path("scripts"), os.environ["PATH"]])
    options = {
        "Python_EXECUTABLE": sys.executable,
        "pybind11_DIR": pybind11.get_cmake_dir(),
        "GIMPSLOPE_GENERIC_ONLY": "ON",
    }
    definitions = [f"-D{name}={value}" for name, value in options.items()]
    run("cmake", "-G", "Ninja", "-S", source, "-B", build, *definitions, PATH=path)
    run("cmake", "--build", build, PATH=path)
    run("cmake", "--install", build, "--prefix", site, PATH=path)


@pytest.mark.slow
def test_shape_function_of_contributing(tmp_path: Path) -> None:
    source, site = tmp_path / "source", tmp_path / "site"
    shutil.copytree(ROOT / "cpp", source / "cpp")
    shutil.copy(ROOT / "CMakeLists.txt", source)
    shutil.copytree(
        ROOT / "python/gimpslope", site / "gimpslope", ignore=shutil.ignore_patterns("_core.*.so")
    )
    shapes, given = source / "cpp/gimpslope/shape", blocks()
    (shapes / "cubic_bspline.hpp").write_text(given["cpp"])
    (shapes / "list.hpp").write_text(changed((shapes / "list.hpp").read_text(), given["diff"]))
    install(source, tmp_path / "build", site)
    # Without site, so that no editable installation comes before this one.
    paths = os.pathsep.join([str(site), *sys.path])
    pytest_run = [sys.executable, "-S", "-m", "pytest", "-p", "no:cacheprovider", CHECKS]
    shown = run(*pytest_run, PYTHONPATH=paths)
    assert re.search(r"=+ 8 passed in [^,]*=+$", shown, re.MULTILINE), shown  # none left out
