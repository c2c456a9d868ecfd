"""A wheel built without threads runs on one and refuses more. It holds the code of every
instruction set, well apart, and chooses at run time; none of it is compiled to compute loosely."""

from __future__ import annotations

import json
import os
import platform
import re
import shlex
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from package_build import ROOT, assert_same_but_for_rounding, slide

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        platform.system() != "Linux",
        reason="reads ELF objects with GNU binutils, which other systems do not have",
    ),
]
x86_64 = pytest.mark.skipif(
    platform.machine() != "x86_64", reason="only x86-64 has instruction sets to choose from"
)

SLIDE = """
import sys
import gimpslope as gs
from gimpslope.studies import reference
solver = gs.Solver.of(reference.slope(cell=0.8), reference.method(threads=int(sys.argv[1])))
solver.advance(100)
print(gs.__file__, solver.energies().kinetic > 0)
"""

LOOSE = {
    "-Ofast",
    "-fassociative-math",
    "-ffast-math",
    "-ffinite-math-only",
    "-fno-signed-zeros",
    "-freciprocal-math",
    "-funsafe-math-optimizations",
}


def output(*command: str | Path) -> str:
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


def objects_of(build: Path, target: str) -> list[Path]:
    found = sorted((build / "CMakeFiles" / f"{target}.dir").rglob("*.o"))
    assert found
    return found


@pytest.fixture(scope="module")
def site(alone: Path) -> Path:
    """The wheel as installed."""
    (wheel,) = alone.parent.glob("*.whl")
    zipfile.ZipFile(wheel).extractall(alone.parent / "site")
    return alone.parent / "site"


def python(site: Path, script: str, *words: str) -> subprocess.CompletedProcess[str]:
    """Runs a script with the wheel, which an editable install would come before but for -S."""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(site), *sys.path])}
    command = [sys.executable, "-S", "-c", script, *words]
    return subprocess.run(command, env=environment, capture_output=True, text=True)


def test_one_thread_runs_and_more_are_refused(site: Path) -> None:
    file, slides = python(site, SLIDE, "1").stdout.split()
    assert Path(file).is_relative_to(site) and slides == "True"
    refused = python(site, SLIDE, "2").stderr
    assert "threads must be 1, for this build has no threads, got 2" in refused


def test_kernel_without_threads_needs_no_thread_library(alone: Path) -> None:
    assert not re.search("thread|futex|atomic", output("nm", "-C", "-u", alone / "libkernel.a"))


@x86_64
def test_code_of_every_instruction_set(alone: Path) -> None:
    def found(target: str) -> set[str]:
        code = output("objdump", "-d", "--no-show-raw-insn", *objects_of(alone, target))
        return set(re.findall("%[xyz]mm", code)) | set(re.findall(r"\tv(?=fmadd)", code))

    assert found("kernel") == found("sweeps_generic") == {"%xmm"}
    assert found("sweeps_x86_64_v3") == {"%xmm", "%ymm", "\tv"}
    assert found("sweeps_x86_64_v4") == {"%xmm", "%ymm", "%zmm", "\tv"}


@x86_64
def test_only_the_sweeps_are_compiled_for_newer_processors(alone: Path) -> None:
    for command in json.loads((alone / "compile_commands.json").read_text()):
        newer = re.findall(r"-m(?:arch|avx|fma)\S*", command["command"])
        (level,) = re.findall(r"sweeps_x86_64_(v\d)\.dir", command["output"]) or [None]
        assert newer == ([f"-march=x86-64-{level}"] if level else []), command["file"]


def test_instruction_sets_share_no_code(alone: Path) -> None:
    """The linker keeps one of several weak functions of a name, which might be one with
    instructions that the processor lacks: each name holds that of its instruction set."""
    for folder in (alone / "CMakeFiles").glob("sweeps_*.dir"):
        name = folder.stem.removeprefix("sweeps_")
        shown = output("nm", "--defined-only", *objects_of(alone, folder.stem))
        weak = [line for line in shown.splitlines() if re.search(" [WVu] ", line)]
        own = re.compile(f"9gimpslope{len(name)}{name}|Eigen_{name}")  # mangled: not all demangle
        assert weak and [line for line in weak if not own.search(line)] == []


@x86_64
@pytest.mark.parametrize(
    ("processor", "chosen"), [("Nehalem", "generic"), ("Haswell", "x86-64-v3")]
)
def test_choice_at_run_time(native_slide: Path, processor: str, chosen: str) -> None:
    emulator = shutil.which("qemu-x86_64-static") or shutil.which("qemu-x86_64")
    if emulator is None:
        pytest.skip("needs an emulator of older processors, qemu-x86_64 (Debian: qemu-user-static)")
    found = slide(emulator, "-cpu", processor, native_slide)
    assert found.instruction_set == chosen
    assert_same_but_for_rounding(found, slide(native_slide, instruction_set="generic"))


def test_nothing_computes_loosely(alone: Path, site: Path) -> None:
    for command in json.loads((alone / "compile_commands.json").read_text()):
        assert LOOSE.isdisjoint(shlex.split(command["command"])), command["file"]
    for source in (ROOT / "cpp").rglob("*.?pp"):
        assert not re.search(r"fast-math|GCC optimize|gnu::optimize", source.read_text()), source
    # A library linked with -ffast-math takes the smallest numbers from all that loads it.
    python(site, "import sys, gimpslope; 1 / (sys.float_info.min / 2)").check_returncode()
