"""`gimpslope converge`: slopes of the study on finer and finer grids."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable
from typing import get_args

from ..method import VolumetricStrain
from ..studies import converge, reference
from ..studies.reproduce.judging import SOIL
from .commands import Commands
from .options import add_readings, add_stone_models
from .paths import make_directory


def add(commands: Commands) -> None:
    """Add the command to a parser."""
    parser = commands.add_parser(
        "converge",
        help="run slopes on finer and finer grids: what converges, to what, at what cost",
        description="Finished runs are taken as they are, so that a study that was stopped goes on "
        "with those that are missing. The page is written anew after each run.",
    )
    parser.set_defaults(prepare=_prepare)
    parser.add_argument(
        "slopes",
        nargs="*",
        metavar="SLOPE",
        help=f"of {', '.join(reference.SLOPES)} (default: {SOIL})",
    )
    add_readings(parser)
    add_stone_models(parser)
    parser.add_argument(
        "--stone-friction",
        type=float,
        nargs="+",
        metavar="DEG",
        help="for each a further model: rigid stones that soil slides along",
    )
    parser.add_argument(
        "--volumetric-strain",
        nargs="+",
        choices=get_args(VolumetricStrain),
        default=[reference.VOLUMETRIC_STRAIN],
        help="each model with each of them (default: point, as in the paper)",
    )
    parser.add_argument(
        "--seed", type=int, nargs="+", metavar="N", help="of the stones (default: 1)"
    )
    parser.add_argument(
        "--cells",
        type=float,
        nargs="+",
        metavar="H",
        help=f"m, each half of the one before (default: {_shown(converge.CELLS)}; with stones "
        f"{_shown(converge.CELLS_WITH_STONES)})",
    )
    parser.add_argument(
        "--duration",
        type=float,
        default=converge.DURATION,
        metavar="S",
        help="of the slides, s (default: %(default)g)",
    )
    parser.add_argument("--threads", type=int, default=1, metavar="N", help="(default: 1)")
    parser.add_argument(
        "--output", default="convergence", metavar="DIR", help="(default: %(default)s)"
    )
    parser.add_argument(
        "--overwrite", action="store_true", help="replace files of other runs in the directory"
    )
    parser.add_argument("--quiet", action="store_true", help="no progress bars")


def _prepare(options: argparse.Namespace) -> Callable[[], int]:
    slopes = list(dict.fromkeys(options.slopes)) or [SOIL]
    of_stones = {
        "--seed": options.seed,
        "--stone-model": options.stone_model,
        "--stone-friction": options.stone_friction,
    }
    for name, given in of_stones.items():
        if slopes == [SOIL] and given is not None:
            raise ValueError(f"{name} must be left out for soil, which has no stones")
    plan = converge.plan(
        options.output,
        slopes=slopes,
        readings=list(dict.fromkeys(options.reading)),
        stone_models=list(dict.fromkeys(options.stone_model or ["deformable"])),
        stone_frictions=list(dict.fromkeys(options.stone_friction or [])),
        volumetric_strains=list(dict.fromkeys(options.volumetric_strain)),
        seeds=options.seed or [1],
        cells=options.cells,
        duration=options.duration,
        threads=options.threads,
        overwrite=options.overwrite,
    )
    make_directory("--output", options.output)

    def command() -> int:
        for studies in converge.converge(plan, progress=not options.quiet):
            converge.write(studies, options.output)
        converge.draw(studies, options.output)
        print("\n".join(converge.markdown(study) for study in studies))
        print(f"runs, tables and figures: {options.output}{os.sep}")
        missing = [run for study in studies for run in study.missing]
        for run in missing:
            print(f"gimpslope: missing {run}", file=sys.stderr)
        return 1 if missing else 0

    return command


def _shown(cells: tuple[float, ...]) -> str:
    return " ".join(f"{cell:g}" for cell in cells)
