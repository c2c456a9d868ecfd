"""The static solution that a slope slides from: what it is, what it costs, what comes of it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from coarse_slope import METHOD, SLOPE, recording, simulate
from rigid_scene import ANGLE_IRON, SPACING, bodies, moments, thrown, turning

import gimpslope as gs
from gimpslope.setup import Setup
from gimpslope.simulation import Simulation
from gimpslope.studies import reference

IN_TIME = gs.Stages(gs.Gravity(0.5), gs.Settling(1e-6))
FIGURES = (
    "peak_kinetic_energy",
    "time_of_peak",
    "speed_at_peak",
    "max_speed",
    "max_displacement_total",
    "max_displacement_horizontal",
    "max_displacement_vertical",
)


@pytest.mark.parametrize("stone", [gs.Elastic(2400, 30e6, 0.2), gs.Rigid(2400)])
def test_unbalanced_force_of_what_is_thrown_is_its_weight(stone: gs.Material) -> None:
    """Without walls and stress nothing balances it; its motion is stopped at once, as it rises."""
    free = gs.Walls(gs.Free(), gs.Free(), gs.Free(), gs.Free())
    disk = gs.stones.Ellipse((2.0, 2.0), (2.0, 2.0))
    scene = replace(SLOPE, cell=0.4, walls=free, stones=[disk], stone=stone)
    solver = gs.Solver.of(scene, gs.Method(courant=0.1))
    solver.velocity = np.tile([0.0, 1e-2], (len(solver), 1))
    solver.set_damping(kinetic=True)
    assert solver.unbalanced_force == np.inf
    while solver.unbalanced_force == np.inf and solver.steps < 10:
        solver.step()
    assert solver.unbalanced_force == pytest.approx(9.81 * solver.mass.sum(), rel=1e-4)


def turned_against_its_spin() -> gs.Solver:
    """A rigid stone that kinetic damping has just stopped, with forces that turn it alone."""
    solver = thrown(ANGLE_IRON, 0.0, 0.0)
    solver.velocity = turning(ANGLE_IRON, -1.0)
    solver.body_force = turning(ANGLE_IRON, 50.0)
    solver.set_damping(kinetic=True)
    while solver.velocity.any():
        solver.step()
    return solver


def test_moment_on_a_rigid_stone_counts_as_a_force_at_its_edge() -> None:
    solver = turned_against_its_spin()
    arm = solver.position - solver.position.mean(axis=0)
    solver.step()
    radius = np.hypot(*arm.T).max() + SPACING / np.sqrt(2)
    moment = solver.mass @ moments(arm, turning(ANGLE_IRON, 50.0))
    assert solver.unbalanced_force == pytest.approx(moment / radius, rel=1e-9)


def test_velocities_that_are_given_are_not_taken_for_a_force() -> None:
    solver = turned_against_its_spin()
    solver.velocity = np.tile([1.0, 0.0], (len(solver), 1))
    solver.step()
    assert solver.unbalanced_force == np.inf


def test_stop_ends_all_motion_and_books_it() -> None:
    disk = gs.stones.Ellipse((4.0, 3.0), (2.0, 2.0))
    scene = replace(SLOPE, stones=[disk], stone=gs.Rigid(2400))
    solver = gs.Solver.of(scene, METHOD, elastic=True)
    solver.advance(50)
    before, damped = solver.energies(), solver.ledger.damping
    assert before.kinetic > 0 and bodies(solver).velocity.any()
    solver.stop()
    after = solver.energies()
    assert after.kinetic == 0 and not solver.velocity.any() and not bodies(solver).velocity.any()
    assert solver.ledger.damping - damped == pytest.approx(before.kinetic, rel=1e-12)
    assert (after.potential, after.elastic) == (before.potential, before.elastic)


def test_slide_starts_from_rest_in_balance(tmp_path: Path) -> None:
    run = simulate(tmp_path / "run.h5", stages=gs.Stages(slide=gs.Slide(0.01)))
    assert run.energy.kinetic[0] == 0 and not run.snapshot(0.0).velocity.any()
    assert 0 < run.trigger["settling_unbalanced"] < run.stages.settling.unbalanced == 2e-3
    assert run.summary["steps_before_slide"] == run.energy.stage("settling").step[-1]


@pytest.mark.parametrize(
    ("method", "share"), [(gs.Method(viscosity=0.5), None), (gs.Method(viscosity=20.0), 0.5)]
)
def test_stages_take_the_longest_steps_and_give_the_methods_back(
    method: gs.Method, share: float | None, tmp_path: Path
) -> None:
    """0.9 of the stable step, or one at which the points keep half of their own velocity."""
    simulation = Simulation(Setup(SLOPE, method, gs.Stages(gs.Gravity(0))))
    solver = simulation.solver
    usual, stable = solver.time_step, solver.stable_time_step
    with recording(simulation, tmp_path / "run.h5") as recorder:
        simulation.load(recorder)
        if share is None:
            assert solver.time_step == pytest.approx(0.9 * stable, rel=1e-9)
        else:
            assert usual < solver.time_step < 0.9 * stable
            assert solver.alpha == pytest.approx(share, rel=1e-9)
        simulation.settle(recorder)
        simulation.release(recorder)
    assert solver.time_step == pytest.approx(0.4 * solver.stable_time_step, rel=1e-9)


def test_forces_left_while_gravity_grew_do_not_count(tmp_path: Path) -> None:
    simulation = Simulation(Setup(SLOPE, METHOD, gs.Stages(gs.Gravity(0.5))))
    with recording(simulation, tmp_path / "run.h5") as recorder:
        simulation.load(recorder)
        assert simulation.solver.unbalanced_force < np.inf
        simulation.settle(recorder)
        assert simulation.solver.time > 0.5


def test_forces_that_stay_are_told(tmp_path: Path) -> None:
    stages = gs.Stages(settling=gs.Settling(unbalanced=1e-12, limit=0.3))
    with pytest.raises(gs.NotSettledError, match=r"limit = 0\.3 s: unbalanced .* = 1e-12"):
        simulate(tmp_path / "run.h5", stages=stages)


CASES = [
    (name, model, reading)
    for reading in reference.READINGS
    for name, model in (("soil", "deformable"), ("round", "rigid"), ("round", "softened"))
]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "model", "reading"), CASES)
def test_slides_from_a_static_solution_are_those_from_loading_in_time(
    name: str, model: str, reading: str, tmp_path: Path
) -> None:
    """Every figure within 0.5 %, for 0.6 of the steps before the slide or less."""
    setup = reference.setup(name, reading=reading, cell=0.2, stone_model=model, duration=5.0)
    runs = [
        replace(setup, stages=replace(stages, slide=gs.Slide(5.0))).simulate(
            tmp_path / f"{number}.h5", progress=False
        )
        for number, stages in enumerate((IN_TIME, gs.Stages()))
    ]
    (before, after), (loaded, static) = ([run.summary for run in runs], runs)
    assert after["steps_before_slide"] <= 0.6 * before["steps_before_slide"]
    off = {key: after[key] / before[key] - 1 for key in FIGURES}
    off["run_out"] = static.run_out() / loaded.run_out() - 1
    print(name, model, reading, {key: f"{100 * value:.3f} %" for key, value in off.items()})
    assert max(map(abs, off.values())) < 0.005


@pytest.mark.slow
@pytest.mark.parametrize("reading", list(reference.READINGS))
@pytest.mark.parametrize("name", list(reference.SLOPES))
def test_steps_before_the_slide(name: str, reading: str, tmp_path: Path) -> None:
    """Prints the steps of loading in time, of a static solution with as little force left, and of
    the usual one. Both take 0.6 of the steps or less."""
    for model in ("deformable",) if name == "soil" else reference.STONE_MODELS:
        setup = reference.setup(name, reading=reading, cell=0.2, stone_model=model, duration=1e-6)

        def load(stages: gs.Stages, setup: Setup = setup) -> tuple[int, float]:
            given = replace(setup, stages=replace(stages, slide=setup.stages.slide))
            run = given.simulate(tmp_path / "run.h5", overwrite=True, progress=False)
            return run.summary["steps_before_slide"], run.trigger["settling_unbalanced"]

        in_time, left = load(IN_TIME)
        same, _ = load(gs.Stages(settling=gs.Settling(unbalanced=left)))
        usual, usually_left = load(gs.Stages())
        print(
            f"{name:9} {model:10} {reading:10} {in_time:6,} steps and {left:.1e} of the weight, "
            f"static {same:6,}; {usual:6,} to {usually_left:.1e}"
        )
        assert max(same, usual) <= 0.6 * in_time
