"""`gimpslope plan`: the cheapest run of a slope for an error that is asked for."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from .. import planning, scene_file
from ..setup import Setup
from ..studies import reference
from .commands import Commands
from .paths import check_file, has_ending


def add(commands: Commands) -> None:
    """Add the command to a parser."""
    parser = commands.add_parser(
        "plan",
        help="find the cheapest run of a slope for an error, and run it",
        description="Pilots on coarse grids tell how fine a grid some results need, and what they "
        "are without grid. Where that cannot be promised, the plan says what it would need.",
    )
    parser.set_defaults(prepare=_prepare)
    parser.add_argument(
        "scene",
        metavar="SCENE",
        help=f"{', '.join(reference.SLOPES)} (the study's slopes A to D), a scene file (.toml), "
        "or a run file (.h5)",
    )
    parser.add_argument(
        "--reading",
        choices=list(reference.READINGS),
        help="of the study's slopes (default: identified)",
    )
    parser.add_argument(
        "--error",
        type=float,
        default=planning.Target.error,
        metavar="E",
        help="asked for, a share of each quantity (default: %(default)s)",
    )
    parser.add_argument(
        "--quantities",
        nargs="+",
        choices=list(planning.QUANTITIES),
        default=list(planning.DEFAULT),
        help=f"(default: {' '.join(planning.DEFAULT)})",
    )
    parser.add_argument("--seed", type=int, metavar="N", help="of the study's stones (default: 1)")
    parser.add_argument(
        "--budget",
        type=float,
        default=planning.Target.budget,
        metavar="S",
        help="wall time that pilots and run may take, s; two pilots are run in any case "
        "(default: %(default)g)",
    )
    parser.add_argument("--threads", type=int, metavar="N", help="(default: 1)")
    parser.add_argument(
        "--output", metavar="FILE", help="ends in .h5 (default: the scene's name + _planned.h5)"
    )
    parser.add_argument("--dry-run", action="store_true", help="make the plan and do not run it")
    parser.add_argument("--overwrite", action="store_true", help="replace an output that exists")
    parser.add_argument("--quiet", action="store_true", help="do not tell of the pilots")


def _prepare(options: argparse.Namespace) -> Callable[[], int]:
    setup = _setup(options)
    if options.threads is not None:
        setup = replace(setup, method=replace(setup.method, threads=options.threads))
    target = planning.Target(options.error, options.quantities, options.budget)
    output = options.output or f"{Path(options.scene).stem}_planned.h5"
    check_file("--output", output, ".h5")
    if Path(output).exists() and not (options.overwrite or options.dry_run):
        raise ValueError(f"--output must be a new file unless --overwrite is given, got {output!r}")

    def command() -> int:
        made = planning.plan(
            setup.scene,
            target.error,
            target.quantities,
            method=setup.method,
            stages=setup.stages,
            budget=target.budget,
            progress=not options.quiet,
        )
        print(made)
        if not options.dry_run:
            print(f"\n{made.run(output, overwrite=options.overwrite)}")
            print(f"run: {output}")
        return 0

    return command


def _setup(options: argparse.Namespace) -> Setup:
    given = {
        name: value
        for name, value in (("reading", options.reading), ("seed", options.seed))
        if value is not None
    }
    if options.scene in reference.SLOPES:
        setup = reference.setup(options.scene, volumetric_strain=None, **given)
        return replace(setup, method=replace(setup.method, ledger=False))
    for name, value in given.items():
        raise ValueError(
            f"--{name} must be left out unless SCENE is one of {', '.join(reference.SLOPES)}, "
            f"got {value!r} with {options.scene!r}"
        )
    if not has_ending(options.scene, ".toml") and not has_ending(options.scene, ".h5"):
        raise ValueError(
            f"SCENE must be one of {', '.join(reference.SLOPES)}, a scene file that ends in .toml, "
            f"or a run file that ends in .h5, got {options.scene!r}"
        )
    return scene_file.load(options.scene)
