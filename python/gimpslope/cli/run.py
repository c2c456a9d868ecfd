"""`gimpslope run`: simulate a slope of the reference study, a scene file, or a run once more."""

from __future__ import annotations

import argparse
import json
import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, get_args

from .. import figures, scene_file
from ..method import VolumetricStrain
from ..recorder import Recorder
from ..run import Run
from ..setup import Setup
from ..simulation import Simulation
from ..studies import comparison, reference
from .commands import Commands
from .options import add_stone_model
from .paths import check_file, has_ending

_OF_SLOPES: dict[str, Any] = {
    "reading": "identified",
    "cell": 0.1,
    "duration": 10.0,
    "seed": 1,
    "stone_model": "deformable",
    "stone_modulus": None,
    "stone_friction": None,
    "time_step": None,
    "courant": None,
    "volumetric_strain": reference.VOLUMETRIC_STRAIN,
}
"""Options that only the slopes of the study have, with their defaults."""

_OF_STONES = {"seed", "stone_model", "stone_modulus", "stone_friction"}


def add(commands: Commands) -> None:
    """Add the command to a parser."""
    parser = commands.add_parser("run", help="simulate a slope", description=__doc__)
    parser.set_defaults(prepare=_prepare)
    parser.add_argument(
        "slope",
        metavar="SLOPE",
        help=f"{', '.join(reference.SLOPES)} (the study's slopes A to D), a scene file (.toml), or "
        "a run file (.h5) to repeat",
    )
    of_slopes = parser.add_argument_group("of the study's slopes")
    of_slopes.add_argument(
        "--reading",
        choices=list(reference.READINGS),
        help=f"how the paper is read where it is silent (default: {_OF_SLOPES['reading']})",
    )
    of_slopes.add_argument("--cell", type=float, metavar="H", help="m (default: 0.1)")
    of_slopes.add_argument(
        "--duration", type=float, metavar="S", help="of the slide, s (default: 10)"
    )
    of_slopes.add_argument("--seed", type=int, metavar="N", help="of the stones (default: 1)")
    add_stone_model(of_slopes)
    step = of_slopes.add_mutually_exclusive_group()
    step.add_argument("--time-step", type=float, metavar="S", help="fixed, s")
    step.add_argument("--courant", type=float, metavar="C", help="Courant number (default: 0.4)")
    of_slopes.add_argument(
        "--volumetric-strain",
        choices=list(get_args(VolumetricStrain)),
        help="cell_average keeps soil from locking (default: point, as in the paper)",
    )
    parser.add_argument(
        "--until-rest",
        action="store_true",
        help="end the slide once its largest displacements and its run-out would change by less "
        "than 0.2 %% in the rest of its duration",
    )
    parser.add_argument("--threads", type=int, metavar="N", help="(default: 1)")
    parser.add_argument(
        "--output", metavar="FILE", help="ends in .h5 (default: the slope's name and .h5)"
    )
    parser.add_argument("--overwrite", action="store_true", help="replace an output that exists")
    parser.add_argument("--summary", metavar="FILE", help="write the summary as JSON")
    parser.add_argument("--figures", metavar="DIR", help="(default: the output's name + _figures)")
    parser.add_argument("--quiet", action="store_true", help="no progress bar")


def _prepare(options: argparse.Namespace) -> Callable[[], int]:
    repeated = Run(options.slope) if has_ending(options.slope, ".h5") else None
    setup = _setup(options, repeated)
    if options.until_rest:
        setup = _until_rest(setup, repeated)
    if options.threads is not None:
        setup = replace(setup, method=replace(setup.method, threads=options.threads))
    output = options.output or _default_output(options.slope, repeated)
    check_file("--output", output, ".h5")
    figure_directory = options.figures or f"{Path(output).with_suffix('')}_figures"
    _check_targets(options, output, figure_directory, repeated)
    simulation = Simulation(setup)
    recorder = Recorder(simulation, output, overwrite=options.overwrite, progress=not options.quiet)
    paper = reference.PAPER.get(options.slope, {})

    def command() -> int:
        run = simulation.run(recorder)
        summary = run.summary
        print(comparison.text(_title(options), summary, paper))
        if repeated is not None:
            print(comparison.repetition(repeated, run))
        if options.summary is not None:
            Path(options.summary).write_text(json.dumps(summary, indent=2) + "\n")
        figures.write_figures(run, figure_directory, paper)
        print(f"run: {output}   figures: {figure_directory}{os.sep}")
        return 0

    return command


def _setup(options: argparse.Namespace, repeated: Run | None) -> Setup:
    given = {name: getattr(options, name) for name in _OF_SLOPES}
    given = {name: value for name, value in given.items() if value is not None}
    if options.slope in reference.SLOPES:
        if options.slope == "soil" and (unused := sorted(_OF_STONES & set(given))):
            raise ValueError(f"{_option(unused[0])} must be left out for soil, which has no stones")
        return reference.setup(options.slope, **(_OF_SLOPES | given), threads=options.threads or 1)
    if given:
        name, value = next(iter(given.items()))
        raise ValueError(
            f"{_option(name)} must be left out unless SLOPE is one of "
            f"{', '.join(reference.SLOPES)}, got {value!r} with {options.slope!r}"
        )
    if repeated is not None:
        return repeated.setup
    if not has_ending(options.slope, ".toml"):
        raise ValueError(
            f"SLOPE must be one of {', '.join(reference.SLOPES)}, a scene file that ends in .toml, "
            f"or a run file that ends in .h5, got {options.slope!r}"
        )
    return scene_file.read(options.slope)


def _until_rest(setup: Setup, repeated: Run | None) -> Setup:
    if repeated is not None:
        raise ValueError(f"--until-rest must be left out of a run to repeat, got {repeated}")
    slide = setup.stages.slide.until_rest()
    return replace(setup, stages=replace(setup.stages, slide=slide))


def _title(options: argparse.Namespace) -> str:
    if options.slope not in reference.SLOPES:
        return Path(options.slope).name
    letter, reading = reference.SLOPES[options.slope], options.reading or _OF_SLOPES["reading"]
    return f"slope {letter}, {options.slope}, {reading}"


def _option(name: str) -> str:
    return "--" + name.replace("_", "-")


def _default_output(slope: str, repeated: Run | None) -> str:
    stem = Path(slope).stem
    return f"{stem}.h5" if repeated is None else f"{stem}_again.h5"


def _check_targets(
    options: argparse.Namespace, output: str, figure_directory: str, repeated: Run | None
) -> None:
    check_file("--summary", options.summary)
    if Path(figure_directory).is_file():
        raise ValueError(f"--figures must be a directory, got the file {figure_directory!r}")
    source = [] if repeated is None else [repeated.path.resolve()]
    written = (output, options.summary, figure_directory)
    targets = [*source, *(Path(path).resolve() for path in written if path)]
    if len(set(targets)) < len(targets):
        raise ValueError(
            "--output, --summary and --figures must name different files, and not the run to "
            f"repeat, got {', '.join(str(target) for target in targets)}"
        )
