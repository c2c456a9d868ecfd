"""The command `gimpslope`: run a slope, verify the solver, measure its speed, show what the build
can do."""

from __future__ import annotations

import argparse
import json
import os
import platform
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import gimpslope as gs

from . import figures
from .recording import Recorder
from .simulation import Simulation
from .studies import bench, convergence, plain_data, reference, verify
from .studies.verify import report


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; the exit code is 0, 2 for refused arguments, 1 for a failed run or a
    check that does not hold, and 130 for one that was interrupted."""
    options = _parser().parse_args(arguments)
    prepare: Callable[[argparse.Namespace], Callable[[], int]] = options.prepare
    try:
        command = prepare(options)
    except (ValueError, TypeError, OSError) as refused:
        print(f"gimpslope: {refused}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    try:
        return command()
    except (gs.Diverged, gs.NotSettledError, OSError) as failed:
        print(f"gimpslope: {failed}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("gimpslope: interrupted", file=sys.stderr)
        return 130


def _run(options: argparse.Namespace) -> Callable[[], int]:
    _check_file("--output", options.output)
    _check_file("--summary", options.summary)
    figure_directory = options.figures or f"{Path(options.output).with_suffix('')}_figures"
    if Path(figure_directory).is_file():
        raise ValueError(f"--figures must be a directory, got the file {figure_directory!r}")
    targets = [Path(p).absolute() for p in (options.output, options.summary, figure_directory) if p]
    if len(set(targets)) < len(targets):
        raise ValueError(
            "--output, --summary and --figures must name different files, "
            f"got {', '.join(str(target) for target in targets)}"
        )
    simulation = Simulation(
        reference.soil_slope(options.reading, options.cell),
        reference.method(
            options.reading,
            courant=options.courant,
            time_step=options.time_step,
            threads=options.threads,
            volumetric_strain=options.volumetric_strain,
        ),
        duration=options.duration,
    )
    recorder = Recorder(
        simulation,
        options.output,
        overwrite=options.overwrite,
        snapshot_times=reference.SNAPSHOT_TIMES,
        progress=not options.quiet,
    )

    def command() -> int:
        run = simulation.run(recorder)
        summary = run.summary
        print(_comparison(summary, options.reading))
        if options.summary is not None:
            Path(options.summary).write_text(json.dumps(summary, indent=2) + "\n")
        figures.write_figures(run, figure_directory, reference.PAPER)
        print(f"run: {options.output}   figures: {figure_directory}{os.sep}")
        return 0

    return command


def _make_directory(option: str, path: str) -> None:
    """Make, before any work is done, the directory for what comes of it."""
    if not path or Path(path).is_file():
        raise ValueError(f"{option} must be a directory, got {path!r}")
    Path(path).mkdir(parents=True, exist_ok=True)


def _check_file(option: str, path: str | None) -> None:
    """Refuse, before any work is done, a file that could not be written after it."""
    if path is None:
        return
    folder = Path(path).absolute().parent
    if Path(path).is_dir() or not folder.is_dir():
        raise ValueError(f"{option} must be a file in a directory that exists, got {path!r}")
    if not os.access(path if Path(path).exists() else folder, os.W_OK):
        raise ValueError(f"{option} must be a file that may be written, got {path!r}")


def _comparison(summary: dict[str, float | int | None], reading: str) -> str:
    rows = [
        ("time of peak kinetic energy", "time_of_peak", "s", "{:g}"),
        ("peak kinetic energy", "peak_kinetic_energy", "kJ/m", ""),
        ("fastest point at the peak", "speed_at_peak", "m/s", "> {:g}"),
        ("largest displacement", "max_displacement_total", "m", "{:g}"),
        ("  horizontal", "max_displacement_horizontal", "m", "{:g}"),
        ("  vertical", "max_displacement_vertical", "m", "{:g}"),
        ("toe", "toe", "m", ""),
        ("final kinetic energy", "final_kinetic_energy", "J/m", ""),
    ]
    lines = [f"{'slope A, reading ' + reading:32}{'paper':>8}{'here':>10}"]
    for title, name, unit, form in rows:
        paper = form.format(reference.PAPER[name]) if form else "-"
        value = summary[name]
        scale = 1e-3 if unit == "kJ/m" else 1.0
        here = "-" if value is None else f"{value * scale:.2f}"
        lines.append(f"{title:32}{paper:>8}{here:>10} {unit}")
    lines.append("The paper swaps the labels of horizontal and vertical; here they are put right.")
    rate = summary["point_steps_per_second"]
    if rate is not None:
        lines.append(
            f"{summary['points']:,} points, {summary['steps']:,} steps in "
            f"{summary['wall_seconds']:.1f} s: {rate / 1e6:.1f} M point-steps/s"
        )
    return "\n".join(lines)


def _verify(options: argparse.Namespace) -> Callable[[], int]:
    names = options.names or verify.NAMES
    for name in names:
        verify.problem(name)
    if options.output is not None:
        _make_directory("--output", options.output)

    def command() -> int:
        solved: list[verify.Solved] = []
        try:
            for one in verify.solve(names, full=options.full):
                solved.append(one)
                print(report.line(one), file=sys.stderr, flush=True)
                if options.output is not None:
                    report.draw(one, options.output)
                    report.write(solved, options.output, full=options.full)
        finally:  # what is solved is shown, also when the rest is interrupted
            if solved:
                print(report.text(solved))
        if options.output is not None:
            print(f"table and figures: {options.output}{os.sep}")
        return 0 if all(one.holds for one in solved) else 1

    return command


def _converge(options: argparse.Namespace) -> Callable[[], int]:
    plans = [
        convergence.plan(
            options.output,
            reading=reading,
            cells=options.cells,
            threads=options.threads,
            overwrite=options.overwrite,
        )
        for reading in options.reading
    ]
    _make_directory("--output", options.output)

    def command() -> int:
        studies = [convergence.converge(grids, progress=not options.quiet) for grids in plans]
        print("\n".join(convergence.markdown(study) for study in studies))
        convergence.write(studies, options.output)
        print(f"runs, table and figures: {options.output}{os.sep}")
        return 0

    return command


def _bench(options: argparse.Namespace) -> Callable[[], int]:
    if options.guard:
        return _guard(options)
    plan = bench.Plan(options.points, options.threads)
    _check_file("--json", options.json)
    directory = "bench" if options.output is None else options.output
    _make_directory("--output", directory)

    def command() -> int:
        results = bench.run(plan, lambda what: print(what, file=sys.stderr, flush=True))
        print(bench.report.text(results))
        if options.json is not None:
            Path(options.json).write_text(plain_data.dumps(results.to_dict()))
        bench.report.write(results, directory)
        print(f"table and picture: {directory}{os.sep}")
        return 0

    return command


def _guard(options: argparse.Namespace) -> Callable[[], int]:
    for name in ("points", "threads", "json", "output"):
        if (given := getattr(options, name)) is not None:
            raise ValueError(f"--{name} must be left out with --guard, got {given!r}")

    def command() -> int:
        ratios = bench.guard.ratios()
        print("\n".join(bench.guard.lines(ratios)))
        failures = bench.guard.failures(ratios)
        for failure in failures:
            print(f"gimpslope: {failure}", file=sys.stderr)
        return 1 if failures else 0

    return command


def _info(_: argparse.Namespace) -> Callable[[], int]:
    def command() -> int:
        print(
            f"gimpslope {gs.__version__}, Python {platform.python_version()}, {platform.machine()}"
        )
        print(f"instruction sets: {', '.join(gs.kernel.instruction_sets())} (the last is used)")
        print(
            f"threads: {'any number' if gs.kernel.has_threads() else 'one, for the build has none'}"
        )
        print(f"processors: {os.cpu_count()}")
        return 0

    return command


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="gimpslope", description=__doc__)
    parser.add_argument("--version", action="version", version=f"gimpslope {gs.__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    run = commands.add_parser("run", help="simulate a slope of the reference study")
    run.set_defaults(prepare=_run)
    run.add_argument("slope", choices=["soil"], help="soil: slope A, homogeneous")
    run.add_argument(
        "--reading",
        choices=list(reference.READINGS),
        default="identified",
        help="how the paper is read where it is silent (default: %(default)s)",
    )
    run.add_argument(
        "--cell", type=float, default=0.1, metavar="H", help="m (default: %(default)s)"
    )
    run.add_argument(
        "--duration", type=float, default=10.0, metavar="S", help="of the slide, s (default: 10)"
    )
    step = run.add_mutually_exclusive_group()
    step.add_argument("--time-step", type=float, metavar="S", help="fixed, s")
    step.add_argument("--courant", type=float, metavar="C", help="Courant number (default: 0.4)")
    run.add_argument(
        "--volumetric-strain",
        choices=["point", "cell_average"],
        default="point",
        help="cell_average keeps soil from locking (default: %(default)s, as in the paper)",
    )
    run.add_argument("--threads", type=int, default=1, metavar="N", help="(default: 1)")
    run.add_argument("--output", default="soil.h5", metavar="FILE", help="(default: %(default)s)")
    run.add_argument("--overwrite", action="store_true", help="replace an output file that exists")
    run.add_argument("--summary", metavar="FILE", help="write the summary as JSON")
    run.add_argument("--figures", metavar="DIR", help="(default: the output's name + _figures)")
    run.add_argument("--quiet", action="store_true", help="no progress bar")

    check = commands.add_parser("verify", help="solve problems with known answers")
    check.set_defaults(prepare=_verify, full=False)
    check.add_argument(
        "names", nargs="*", metavar="NAME", help=f"all, or some of {', '.join(verify.NAMES)}"
    )
    size = check.add_mutually_exclusive_group()
    size.add_argument(
        "--quick", dest="full", action="store_false", help="in a minute (the default)"
    )
    size.add_argument("--full", action="store_true", help="finest grids and all cases, in minutes")
    check.add_argument(
        "--output", metavar="DIR", help="write the table (Markdown, JSON) and the figures"
    )

    finer = commands.add_parser(
        "converge", help="run slope A on finer and finer grids; finished runs are taken as they are"
    )
    finer.set_defaults(prepare=_converge)
    finer.add_argument(
        "--reading",
        nargs="+",
        choices=list(reference.READINGS),
        default=list(reference.READINGS),
        help="(default: both)",
    )
    finer.add_argument(
        "--cells",
        type=float,
        nargs="+",
        default=list(convergence.CELLS),
        metavar="H",
        help="m, each half of the one before (default: 0.4 0.2 0.1 0.05)",
    )
    finer.add_argument("--threads", type=int, default=1, metavar="N", help="(default: 1)")
    finer.add_argument(
        "--output", default="convergence", metavar="DIR", help="(default: %(default)s)"
    )
    finer.add_argument(
        "--overwrite", action="store_true", help="replace files of other runs in the directory"
    )
    finer.add_argument("--quiet", action="store_true", help="no progress bars")

    speed = commands.add_parser("bench", help="measure the speed of the kernel on slope A")
    speed.set_defaults(prepare=_bench)
    speed.add_argument(
        "--points",
        type=int,
        nargs="+",
        metavar="N",
        help=f"(default: {' '.join(map(str, bench.SIZES))})",
    )
    speed.add_argument(
        "--threads", type=int, nargs="+", metavar="N", help="(default: 1 and all processors)"
    )
    speed.add_argument("--json", metavar="FILE", help="write the measurements as JSON")
    speed.add_argument(
        "--output", metavar="DIR", help="for the table and the picture (default: bench)"
    )
    speed.add_argument(
        "--guard",
        action="store_true",
        help="fail if the kernel has become slow against the plain loop, and measure nothing else",
    )

    info = commands.add_parser("info", help="show version and instruction sets")
    info.set_defaults(prepare=_info)
    return parser


if __name__ == "__main__":
    sys.exit(main())
