"""The energy ledger: every joule is somewhere, and where theory says."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from coarse_slope import METHOD, simulate
from kernel_scene import sliding, solver

import gimpslope as gs
from gimpslope import _core
from gimpslope._check import FloatArray
from gimpslope.figures import ledger as draw_ledger
from gimpslope.io import hdf5
from gimpslope.ledger import SINKS

G = 9.81
ROCK = gs.Elastic(density=2000, young=1e6, poisson=0.3)


def rectangle(width: float, height: float) -> gs.Outline:
    return gs.Outline(np.array([(0, 0), (width, 0), (width, height), (0, height)]))


def balance(solver: gs.Solver) -> float:
    """The sum that must stay constant, J/m."""
    energies, ledger = solver.energies(), solver.ledger
    state = energies.kinetic + energies.potential + energies.elastic
    return state + ledger.taken


def block(walls: gs.Walls, method: gs.Method, material: gs.Material = ROCK) -> gs.Solver:
    """Six by three metres on a grid of half a metre, without gravity."""
    scene = gs.Scene(rectangle(6.0, 3.0), material, cell=0.5, walls=walls)
    return gs.Solver(
        scene.points,
        scene.materials,
        cell=scene.cell,
        walls=walls,
        wall_positions=scene.wall_positions,
        method=replace(method, ledger=True),
    )


FREE = gs.Walls(gs.Free(), gs.Free(), gs.Free(), gs.Free())
ON_FLOOR = replace(FREE, bottom=gs.Roller())


# A bar in its first mode: T = 10 s, kinetic and elastic energy swing into each other.

PERIOD, LENGTH, CELLS = 10.0, 25.0, 50
WAVE_NUMBER, FREQUENCY = np.pi / (2 * LENGTH), 2 * np.pi / PERIOD


def bar(method: gs.Method) -> gs.Solver:
    cell = LENGTH / CELLS
    walls = gs.Walls(gs.Fixed(), gs.Free(), gs.Roller(), gs.Roller())
    scene = gs.Scene(rectangle(LENGTH, cell), gs.Elastic(1.0, 100.0, 0.0), cell=cell, walls=walls)
    along = scene.points.position[:, 0]
    return gs.Solver(
        scene.points,
        scene.materials,
        cell=cell,
        walls=walls,
        wall_positions=scene.wall_positions,
        velocity=np.column_stack([0.1 * np.sin(WAVE_NUMBER * along), 0 * along]),
        method=replace(method, ledger=True),
    )


def residues(dt: float) -> tuple[float, FloatArray]:
    """Energy at the start, and after each step of one period what integration, transfer and wall
    have taken, J/m."""
    swinging = bar(gs.Method(alpha=0.0, time_step=dt))
    start = balance(swinging)
    rows = []
    for _ in range(round(PERIOD / dt)):
        swinging.step()
        ledger = swinging.ledger
        rows.append(ledger.integration + ledger.transfer + ledger.impact)
        assert balance(swinging) == pytest.approx(start, rel=1e-10)
    return start, np.array(rows)


def test_elastic_vibration_closes_and_its_residue_is_that_of_the_staggered_step() -> None:
    """The stress of a step is half a step older than its velocities, so what is missing is dt/2
    times the rate of the elastic energy E sin^2(w t), at most dt E w / 2, and nothing after a
    period. The integration gives back what the lumped masses take."""
    dt = 0.02
    energy, coarse = residues(dt)
    _, fine = residues(dt / 2)
    assert np.abs(coarse).max() == pytest.approx(dt * energy * FREQUENCY / 2, rel=0.01)
    assert np.abs(coarse).max() / np.abs(fine).max() == pytest.approx(2, rel=0.01)
    assert abs(coarse[-1]) < 1e-3 * np.abs(coarse).max()


@pytest.mark.parametrize("alpha", [0.01, 0.05])
def test_transfer_loss_is_that_of_the_viscosity(alpha: float) -> None:
    """A mode of wave number k loses exp(-nu k^2 t) of its energy, with the nu of the blend."""
    dt, periods = 0.005, 4
    swinging = bar(gs.Method(alpha=alpha, time_step=dt))
    energy = balance(swinging)
    swinging.advance_to(periods * PERIOD)
    cell = LENGTH / CELLS
    viscosity = alpha * cell**2 * (1 / 6 + (1 / 4) ** 2 / 3) / dt
    lost = energy * (1 - np.exp(-viscosity * WAVE_NUMBER**2 * periods * PERIOD))
    assert swinging.ledger.transfer == pytest.approx(lost, rel=0.05)
    assert balance(swinging) == pytest.approx(energy, rel=1e-10)


def test_flip_loses_next_to_nothing() -> None:
    """Lumped masses lose (dt^2 / 2) a (M_lumped - M_consistent) a a step, half as much over the
    same time at half the step, beside what wall nodes take from the first motion at any step."""
    lost = []
    for dt in (0.02, 0.01):
        swinging = bar(gs.Method(alpha=0.0, time_step=dt))
        energy = balance(swinging)
        swinging.advance_to(PERIOD)
        lost.append(swinging.ledger.transfer)
    assert 0 < lost[1] < lost[0] < 1e-4 * energy
    assert 1.5 < lost[0] / lost[1] < 2.05


def test_rate_law_takes_energy_as_volumes_change() -> None:
    """Where s = E ln F acts on a volume that grows with F, the work of a mass is E (e^2/2 + e^3/3),
    e = ln F, and the elastic energy E (e^2/2 + e^3/2): the law gives the difference."""
    swinging = bar(gs.Method(alpha=0.0, time_step=0.005))
    swinging.advance_to(PERIOD / 4)
    largest = 0.1 / FREQUENCY * WAVE_NUMBER  # strain at the fixed end
    cubes = largest**3 * 4 / (3 * np.pi) * LENGTH * (LENGTH / CELLS)  # integral of e^3
    assert swinging.ledger.hypoelastic == pytest.approx(-100.0 * cubes / 6, rel=0.03)


# Each entry by itself


def test_free_fall_has_the_residue_of_its_sums() -> None:
    """Symplectic Euler falls dt^2 g n (n+1) / 2 where it should fall dt^2 g n^2 / 2."""
    dt, n = 1e-3, 100
    falling = block(FREE, gs.Method(time_step=dt, alpha=0.0))
    falling.set_gravity(0.0, -G)
    falling.advance(n)
    mass = falling.mass.sum()
    assert falling.ledger.integration == pytest.approx(mass * G**2 * dt**2 * n / 2, rel=1e-9)
    others = falling.ledger._replace(integration=0.0)
    assert np.abs(others).max() < 1e-9 * falling.energies().kinetic


def test_body_force_and_ramp_do_external_work() -> None:
    """A uniform body force b does m b . u; a ramp holds back what gravity does not yet do."""
    dt, n = 1e-3, 200
    pushed = block(FREE, gs.Method(time_step=dt, alpha=0.0))
    pushed.body_force = np.tile([3.0, 4.0], (len(pushed), 1))
    pushed.advance(n)
    kinetic = pushed.mass.sum() * (5.0 * dt * n) ** 2 / 2
    assert pushed.ledger.external == pytest.approx(kinetic, rel=1e-9)

    ramped = block(FREE, gs.Method(time_step=dt, alpha=0.0))
    ramped.set_gravity(0.0, -G, ramp=10.0)
    start = balance(ramped)
    ramped.advance(n)
    assert ramped.ledger.external < 0
    assert balance(ramped) == pytest.approx(start, rel=1e-10)


def test_friction_takes_mu_n_times_the_slide() -> None:
    """A block slides on a Coulomb floor under tilted gravity: friction mu m g_n a metre.

    The share of PIC keeps it from bouncing, so that the weight rests on the floor all the time.
    """
    mu, down, along = 0.2, 8.0, 5.0
    stiff = gs.Elastic(2000, 1e8, 0.3)
    sliding_block = block(replace(FREE, bottom=gs.Coulomb(mu)), gs.Method(alpha=0.1), stiff)
    sliding_block.set_gravity(0.0, -down, ramp=1.0)
    sliding_block.set_damping(local=0.5)
    sliding_block.advance_to(1.5)
    sliding_block.set_damping()
    sliding_block.reset_clock()
    sliding_block.set_gravity(along, -down)
    start, place = balance(sliding_block), sliding_block.position[:, 0].mean()
    sliding_block.advance_to(1.0)
    slide = sliding_block.position[:, 0].mean() - place
    expected = mu * sliding_block.mass.sum() * down * slide
    assert sliding_block.ledger.friction == pytest.approx(expected, rel=0.005)
    assert balance(sliding_block) == pytest.approx(start, rel=1e-10)


@pytest.mark.parametrize("left", [gs.Roller(), gs.Fixed(), gs.Coulomb(0.0)])
def test_nothing_rubs_off_on_smooth_walls(left: gs.Roller | gs.Fixed | gs.Coulomb) -> None:
    """A block thrown into a corner of smooth walls: what the walls take is impact."""
    walls = replace(FREE, left=left, bottom=gs.Coulomb(0.0))
    thrown = block(walls, gs.Method(alpha=0.01))
    thrown.set_gravity(0.0, -G)
    thrown.velocity = np.tile([-2.0, -1.0], (len(thrown), 1))
    start = balance(thrown)
    thrown.advance(300)
    assert thrown.ledger.impact > 0.01 * thrown.mass.sum()
    assert abs(thrown.ledger.friction) < 1e-9 * thrown.ledger.impact
    assert balance(thrown) == pytest.approx(start, rel=1e-10)


@pytest.mark.parametrize("damping", [{"local": 0.3}, {"kinetic": True}])
def test_damping_takes_what_is_missing(damping: dict[str, float]) -> None:
    """Under gravity the start has rho^2 g^2 H^3 / (6 M) a metre of width more than the state of
    rest: half of the work of the weight on the static settlement. M = E without a Poisson's ratio;
    the settlement of 0.9 % of the height is the error of small strains."""
    material = gs.Elastic(2000, 1e7, 0.0)
    resting = block(ON_FLOOR, gs.Method(alpha=0.0), material)
    resting.set_gravity(0.0, -G)
    resting.set_damping(**damping)
    start = balance(resting)
    resting.advance_to(4.0)
    excess = 6.0 * (2000 * G) ** 2 * 3.0**3 / (6 * 1e7)
    assert resting.energies().kinetic < 1e-4 * excess
    assert resting.ledger.damping == pytest.approx(excess, rel=0.02)
    assert balance(resting) == pytest.approx(start, rel=1e-10)


def test_plastic_work_of_a_crushed_block() -> None:
    """A soft block thrown at a wall loses all of its energy to plastic work, the wall and the grid;
    plastic work is never negative, and no entry but the residue falls."""
    clay = gs.DruckerPrager(2000, 1e6, 0.3, friction=0.0, cohesion=5e3, cone="plane_strain")
    thrown = block(replace(FREE, left=gs.Roller()), gs.Method(alpha=0.01), clay)
    thrown.velocity = np.tile([-5.0, 0.0], (len(thrown), 1))
    start = balance(thrown)
    before = thrown.ledger
    for _ in range(200):
        thrown.step()
        now = thrown.ledger
        assert now.plastic >= before.plastic - 1e-9 * start
        assert now.impact >= before.impact - 1e-9 * start
        before = now
    assert now.plastic > 0.3 * start
    assert balance(thrown) == pytest.approx(start, rel=1e-10)


def test_the_entries_do_not_depend_on_the_threads() -> None:
    found = []
    for threads in (1, 2, 3):
        slide = solver(sliding(), threads=threads, ledger=True)
        slide.advance(150)
        found.append(slide.ledger())
    assert found[0] == found[1] == found[2]
    assert min(found[0][name] for name in ("plastic", "friction", "transfer")) > 0


@pytest.mark.parametrize("instruction_set", _core.instruction_sets())
@pytest.mark.parametrize(
    "options",
    [
        {},
        {"damping": (0.3, False)},
        {"volumetric_strain": "cell_average"},
        {"scheme": "usl"},
        {"scheme": "musl"},
    ],
    ids=lambda options: "-".join(map(str, options.values())) or "default",
)
def test_the_ledger_changes_nothing(options: dict[str, Any], instruction_set: str) -> None:
    scene = sliding() | options
    plain, accounted = (
        solver(scene, ledger=ledger, instruction_set=instruction_set) for ledger in (False, True)
    )
    for slide in (plain, accounted):
        slide.advance(100)
    for name in ("position", "velocity", "stress", "plastic_strain"):
        np.testing.assert_array_equal(plain.get(name), accounted.get(name))


def test_refused_without_a_ledger() -> None:
    scene = gs.Scene(rectangle(1.0, 1.0), ROCK, cell=0.5)
    with pytest.raises(ValueError, match="ledger"):
        _ = gs.Solver.of(scene).ledger


def test_entries_have_the_same_names_everywhere() -> None:
    """In the kernel, in Python and in the run file."""
    names = gs.Ledger._fields
    assert tuple(solver(sliding(8, 8), ledger=True).ledger()) == names
    assert tuple(hdf5.LEDGER) == names
    assert set(names) == {*SINKS, "external"}


# In a run


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> gs.Run:
    assert METHOD.ledger
    return simulate(tmp_path_factory.mktemp("ledger") / "slope.h5")


def test_run_closes_with_a_small_residue(run: gs.Run) -> None:
    rows = run.ledger
    assert len(rows) == len(run.energy)
    np.testing.assert_allclose(rows.balance, rows.balance[0], rtol=1e-10)
    assert np.abs(rows.integration).max() < 0.005 * rows.turned_over
    assert rows.plastic[0] == pytest.approx(run.trigger["energy_released"], rel=1e-12)
    assert sum(rows.shares().values()) == pytest.approx(1, rel=1e-9)
    assert rows.shares()["plastic"] > 0.5


def test_other_stages_have_ledgers_too(run: gs.Run) -> None:
    loading, settling = run.ledger.stage("gravity"), run.ledger.stage("settling")
    assert loading.external[-1] < 0  # the ramp holds the weight back
    assert (settling.damping > 0).all() and settling.plastic[-1] == pytest.approx(0, abs=1e-6)
    np.testing.assert_allclose(loading.balance, loading.balance[0], rtol=1e-10)


def test_a_run_that_never_slid(tmp_path: Path) -> None:
    never = gs.Stages(gs.Gravity(0.1), gs.Settling(ratio=1e-30, limit=0.1))
    with pytest.raises(gs.NotSettledError):
        simulate(tmp_path / "never.h5", stages=never)
    rows = gs.open(tmp_path / "never.h5").ledger
    for use in (rows.shares, rows.plot, lambda: rows.turned_over):
        with pytest.raises(ValueError, match="must have energy rows"):
            use()


def test_run_is_drawn(run: gs.Run) -> None:
    ax = run.ledger.plot()
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert {"plastic work", "kinetic", "residues of step and rate law"} <= set(labels)
    assert "friction at walls" not in labels  # both walls are fixed
    assert ax is draw_ledger(run.ledger, ax)


def test_run_without_ledger_says_so(tmp_path: Path) -> None:
    short = gs.Stages(gs.Gravity(0.1), gs.Settling(ratio=0.9), gs.Slide(duration=0.02))
    run = simulate(tmp_path / "plain.h5", method=replace(METHOD, ledger=False), stages=short)
    with pytest.raises(ValueError, match=r"Method\(ledger=True\)"):
        _ = run.ledger
