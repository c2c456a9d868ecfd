"""A plan finds the grid for an error, says what it knows of it, and promises no more."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gimpslope as gs
from gimpslope import planning
from gimpslope.planning import Estimate, blend, grids, savings, search, stones
from gimpslope.planning.cost import seconds
from gimpslope.planning.pilot import Pilot
from gimpslope.planning.problem import pose
from gimpslope.planning.tail import NO_TAIL, tail
from gimpslope.studies import reference

CELLS = (0.8, 0.4, 0.2)
PEAK = ("peak_kinetic_energy", "time_of_peak")


def estimate(*raw: float, fixed: float = 0.0) -> Estimate:
    return Estimate("max_displacement_total", CELLS[: len(raw)], raw, fixed)


@pytest.mark.parametrize("order", [0.7, 1.0, 1.8])
def test_a_power_of_the_cell_is_extrapolated_and_predicted(order: float) -> None:
    found = estimate(*(5.0 - 2.0 * cell**order for cell in CELLS), fixed=0.01)
    assert found.stands == "converges, limit"
    assert found.value == pytest.approx(5.0)
    off = 2.0 * 0.2**order / 5.0
    assert found.error == pytest.approx(1.25 * off + 0.01)
    assert found.raw_error == pytest.approx(2.25 * off + 0.01)
    assert found.predicted(2) == pytest.approx(1.25 * off / 4**order + 0.01)
    assert found.at_worst(2) == pytest.approx(1.25 * off / 2 + 0.01)
    levels = found.levels(0.02)
    assert levels is not None and found.predicted(levels) <= 0.02 < found.predicted(levels - 1)
    assert found.levels(0.009) is None  # finer grids do not help what is fixed


@pytest.mark.parametrize(
    ("raw", "behaviour", "spread"),
    [
        ((9.0, 10.0, 9.6), "oscillates", 0.4),
        ((9.0, 10.0, 10.01), "order not settled", 0.25),
        ((9.0, 10.0, 9.99), "oscillates", 0.25),
        ((9.0, 9.5, 10.5), "diverges", 1.0),
        ((9.0, 10.0), "too few grids", 1.0),
    ],
)
def test_where_no_order_is_settled_the_finest_stands(
    raw: tuple[float, ...], behaviour: str, spread: float
) -> None:
    found = estimate(*raw)
    assert found.stands == f"{behaviour}, finest grid"
    assert found.value == raw[-1]
    assert found.error == pytest.approx(3 * spread / raw[-1])
    assert (found.levels(0.5 * found.error) is None) == (behaviour == "diverges")


@pytest.mark.parametrize("raw", [(9.0, 10.0, math.nan), (0.0, 0.0, 0.0)])
def test_nothing_is_said_of_what_is_not_there(raw: tuple[float, ...]) -> None:
    found = estimate(*raw)
    assert math.isinf(found.error) and found.levels(0.5) is None
    assert found.shown == "not reached"


@pytest.mark.parametrize("given", [{"alpha": 0.02}, {"relaxation_time": 0.03}, {"viscosity": 0.1}])
def test_blend_is_held_as_the_viscosity_it_has(given: dict[str, float]) -> None:
    scene = reference.slope(cell=0.8)
    method = gs.Method(**given)
    held = blend.held(scene, method)
    assert held.blend[0] == "viscosity"
    share = gs.Solver.of(scene, held).alpha
    assert share == pytest.approx(gs.Solver.of(scene, method).alpha, rel=1e-9)


@pytest.mark.parametrize("shape", ["linear", "cpgimp", "quadratic_bspline"])
def test_blend_is_held_with_every_shape(shape: str) -> None:
    scene = reference.slope(cell=0.8)
    method = gs.Method(shape=shape, alpha=0.02)
    share = gs.Solver.of(scene, blend.held(scene, method)).alpha
    assert share == pytest.approx(0.02, rel=1e-9)


@pytest.mark.parametrize("transfer", ["apic", "xpic"])
def test_transfers_without_a_blend_are_planned(small: gs.Scene, transfer: Any) -> None:
    method = gs.Method(transfer=transfer, courant=0.3)
    posed = pose(small, 0.5, method, gs.Stages(), until_rest=False)
    assert posed.on(2).method == method.of(small.materials)


@pytest.mark.parametrize(
    "given", [{"transfer": "apic"}, {"scheme": "musl"}, {"precision": "single"}]
)
def test_stones_stay_where_the_method_has_none_that_are_rigid(given: dict[str, Any]) -> None:
    posed = pose(
        with_stones(0.5, reference.rock()), 0.5, gs.Method(**given), gs.Stages(), until_rest=False
    )
    assert posed.setup.scene.stone == reference.rock()


def test_a_blend_beyond_all_of_pic_takes_shorter_steps() -> None:
    scene = reference.slope(cell=0.8)
    method = gs.Method(viscosity=100.0, courant=0.4)
    with pytest.raises(ValueError, match="viscosity"):
        gs.Solver.of(scene, method)
    assert gs.Solver.of(scene, blend.within_limits(scene, method)).alpha == pytest.approx(0.9)
    gentle = replace(method, viscosity=0.5)
    assert blend.within_limits(scene, gentle) is gentle


@pytest.mark.parametrize(("share", "first"), [(0.6, 0.6), (1.0, 0.9)])
def test_steps_are_no_longer_than_the_blend_allows_on_the_coarsest_grid(
    monkeypatch: pytest.MonkeyPatch, share: float, first: float
) -> None:
    """A step twice as long would need twice the share."""
    scene = gs.Scene(gs.Outline.slope(2, 1), reference.soil(), cell=0.5)
    assert grids.coarsest(scene) == scene
    posed = pose(scene, 0.5, gs.Method(alpha=share), gs.Stages(), until_rest=False)
    same = (1.0, 1.0)
    found = tried(monkeypatch, posed.setup, same, same, same)
    for setup, expected in ((posed.setup, first), (found.setup, 0.9)):
        assert gs.Solver.of(scene, setup.method).alpha == pytest.approx(expected, rel=1e-4)


def with_stones(gap: float, rock: gs.Material, cell: float = 0.2) -> gs.Scene:
    pair = [gs.Ellipse((2.0, 2.0), (1.0, 1.0)), gs.Ellipse((3.0 + gap, 2.0), (1.0, 1.0))]
    return gs.Scene(gs.Outline.slope(), reference.soil(), stones=pair, stone=rock, cell=cell)


@pytest.mark.parametrize(("gap", "apart"), [(0.5, True), (0.3, False)])
def test_stones_as_a_grid_has_them(gap: float, apart: bool) -> None:
    scene = with_stones(gap, reference.rock())
    seen = stones.sampling(scene)
    assert seen is not None
    assert seen.apart == apart and seen.close == (0.0 if apart else 1.0)
    assert seen.gap == pytest.approx(gap / 0.2)
    points = int((scene.points.stone >= 0).sum())
    assert seen.area == pytest.approx(points * 0.1**2 / (np.pi / 2))
    assert stones.cell_apart(scene) == pytest.approx(gap / 2)


def test_stiff_and_strong_stones_become_rigid() -> None:
    scene, why = stones.made_rigid(with_stones(0.5, reference.rock()), 0.01)
    assert scene.stone == gs.Rigid(2400) and "rigid" in why
    assert stones.made_rigid(scene, 0.01) == (scene, "")


@pytest.mark.parametrize("changed", [{"young": 0.3e9}, {"cohesion": 50e3}])
def test_soft_or_weak_stones_stay(changed: dict[str, float]) -> None:
    scene = with_stones(0.5, replace(reference.rock(), **changed))
    kept, why = stones.made_rigid(scene, 0.001)
    assert kept == scene and "stay deformable" in why


def test_the_coarsest_grid_bears_outline_and_stones() -> None:
    assert grids.coarsest(reference.slope(cell=0.2)).cell == pytest.approx(0.8)
    assert grids.coarsest(reference.slope(cell=2.0)).cell == 2.0
    assert grids.coarsest(with_stones(0.5, reference.rock(), cell=0.2)).cell == pytest.approx(0.4)
    fine = reference.slope(cell=0.4)
    assert grids.n_points(fine, 0) == pytest.approx(fine.n_points, rel=0.02)
    assert grids.finer(fine, 2).cell == pytest.approx(0.1)


def pilot(run: gs.Run, **given: object) -> Pilot:
    made = {
        "cell": 0.8,
        "points": 400,
        "steps": 1000,
        "loading_steps": 100,
        "seconds": 1.0,
        "stepping": 1.0,
        "reached": 10.0,
        "values": {},
        "history": {},
        "run": run,
    }
    return Pilot(**(made | given))  # type: ignore[arg-type]


def test_time_follows_from_steps_and_points(tmp_path: Path) -> None:
    """What is spent beside the steps of a coarse pilot tells nothing of a step."""
    none = gs.Run.__new__(gs.Run)

    def taken(points: int, steps: int, beside: float) -> Pilot:
        stepping = steps * (1e-4 + 1e-6 * points)
        return pilot(none, points=points, steps=steps, seconds=stepping + beside, stepping=stepping)

    pilots = [taken(400, 1000, 0.9), taken(1600, 2000, 0.2)]
    assert seconds(pilots, 6400, 1) == pytest.approx(4000 * (1e-4 + 6.4e-3) + 4 * 0.2)
    whole, loading = 2000, 100
    half = loading + 0.5 * (whole - loading)
    assert seconds(pilots, 1600, 0, 0.5) == pytest.approx(half * (1e-4 + 1.6e-3) + 0.1)


class Peaked:
    """A run of which only the time of the peak is asked."""

    def __init__(self, time: float) -> None:
        self.energy = type("E", (), {"peak": type("P", (), {"time": time})})


@pytest.mark.parametrize(("error", "end"), [(0.2, 3.0), (0.05, 4.0), (0.001, math.inf)])
def test_a_slide_ends_when_coarse_grids_agree_on_the_rest(error: float, end: float) -> None:
    def creeping(share: float) -> Pilot:
        history = {time: {"run_out": 5.0 / (1 + share / 2**time)} for time in (2.0, 3.0, 4.0, 5.0)}
        run = Peaked(1.6)
        return pilot(run, values={"run_out": 5.0}, history=history)  # type: ignore[arg-type]

    found = tail(creeping(0.16), creeping(0.12), error)
    assert found.time == end
    if found is not NO_TAIL:
        assert found.extend({"run_out": 4.0, "time_of_peak": 1.6}) == {
            "run_out": pytest.approx(4.0 * (1 + 0.12 / 2**end)),
            "time_of_peak": 1.6,
        }
        assert found.error["run_out"] == pytest.approx(0.06 / 2**end)


@pytest.fixture(scope="module")
def small() -> gs.Scene:
    return gs.Scene(gs.Outline.slope(height=4.5, crest=1), reference.soil(), cell=0.4)


METHOD = gs.Method(viscosity=0.2)


NO_RUN = gs.Run.__new__(gs.Run)


class Given(search.Search):
    """A search that knows what a finer grid costs."""

    def seconds(self, levels: int) -> float:
        return 3.0 * levels


@pytest.mark.parametrize(("change", "tries"), [(0.0, 1), (1.0, 3)])
@pytest.mark.parametrize("left", [5.9, 6.1])
def test_time_that_is_spent_counts(
    monkeypatch: pytest.MonkeyPatch, small: gs.Scene, change: float, tries: int, left: float
) -> None:
    """Of a further pilot of 3 s, it leaves the half or not."""
    problem = pose(small, 0.5, METHOD, gs.Stages(), until_rest=False)
    saved = savings.Saved(problem.setup, pilot(NO_RUN), {PEAK[0]: 0.0}, (), 4.0)
    monkeypatch.setattr(search, "Search", Given)
    monkeypatch.setattr(search, "save", lambda *_: saved)
    monkeypatch.setattr(search, "tail", lambda *_: NO_TAIL)
    monkeypatch.setattr(search, "change", lambda *_: {PEAK[0]: change})
    monkeypatch.setattr(
        search, "fly", lambda *_, **__: pilot(NO_RUN, seconds=2.0, values={PEAK[0]: 1.0})
    )
    target = planning.Target(0.5, PEAK[:1], tries * 6.0 + left)
    found = search.search(problem, target, Path(), progress=False)
    further = left > 6
    assert len(found.pilots) == 2 + further
    assert found.spent == tries * 6.0 + 2.0 * further
    assert found.left == pytest.approx(left - 2.0 * further)


def tried(
    monkeypatch: pytest.MonkeyPatch, setup: gs.Setup, *values: tuple[float, float]
) -> savings.Saved:
    """What is saved where the runs, in turn, give these values."""
    runs = (pilot(NO_RUN, values=dict(zip(PEAK, pair, strict=True))) for pair in values)
    monkeypatch.setattr(savings, "fly", lambda *_: next(runs))
    return savings.save(setup, planning.Target(0.1, PEAK), Path())


def test_what_is_saved_already_is_not_tried(
    monkeypatch: pytest.MonkeyPatch, small: gs.Scene
) -> None:
    method = replace(METHOD, courant=0.95)
    setup = gs.Setup(small, method, gs.Stages(gravity=gs.Gravity(ramp=0.0)))
    found = tried(monkeypatch, setup, (1.0, 1.0))
    assert found.setup == setup and found.reasons == ()


@pytest.mark.parametrize("order", [1, -1])
def test_a_saving_of_unknown_effect_is_not_kept(
    monkeypatch: pytest.MonkeyPatch, small: gs.Scene, order: int
) -> None:
    unknown = (1.0, math.nan)[::order]
    setup = gs.Setup(small, METHOD)
    found = tried(monkeypatch, setup, unknown, unknown, unknown)
    assert found.setup == setup
    assert all("not kept" in why and "not reached" in why for why in found.reasons)
    assert len(found.reasons) == 2


@pytest.fixture(scope="module")
def plan(small: gs.Scene) -> gs.Plan:
    return gs.plan(
        small,
        0.5,
        ("peak_kinetic_energy", "run_out"),
        method=METHOD,
        stages=gs.Stages(slide=gs.Slide(4.0)),
        budget=1000,
        progress=False,
    )


def test_plan_of_a_small_slope(plan: gs.Plan, small: gs.Scene, tmp_path: Path) -> None:
    assert plan.holds
    assert plan.setup.scene == replace(small, cell=plan.setup.scene.cell)
    assert plan.setup.method.viscosity == METHOD.viscosity
    assert all(one.predicted(plan.levels) <= 0.5 for one in plan.estimates.values())
    answer = plan.run(tmp_path / "small.h5")
    assert answer.run.setup == plan.setup == gs.open(tmp_path / "small.h5").setup
    found = {"peak_kinetic_energy": answer.run.energy.peak.value, "run_out": answer.run.run_out()}
    for name, one in answer.estimates.items():
        to_come = plan._search.tail.growth.get(name, 1.0)  # of a slide that ends early
        assert one.raw[-1] == pytest.approx(found[name] * to_come, rel=0.02)
        assert one.cells[-1] == plan.setup.scene.cell
    assert answer.reached == all(one.error <= 0.5 for one in answer.estimates.values())
    for text in (str(plan), str(answer)):
        assert "peak kinetic energy" in text and "run-out of the toe" in text
    with pytest.raises(FileExistsError, match=r"small\.h5"):
        plan.run(tmp_path / "small.h5")


def test_a_plan_beyond_its_budget_says_what_it_would_need(small: gs.Scene, tmp_path: Path) -> None:
    plan = gs.plan(small, 0.05, PEAK[:1], method=METHOD, budget=1e-3, progress=False)
    assert not plan.holds and plan.levels == 0
    assert "cannot promise 0.05" in str(plan)
    assert any("needs a cell" in reason and "budget" in reason for reason in plan.reasons)
    folder, answer = plan._directory, plan.run(tmp_path / "small.h5")
    del plan
    assert all(len(grid.run.final.position) == grid.points for grid in answer.grids)
    del answer
    assert not folder.exists()  # the pilots' files go with plan and answer


def test_stones_that_share_nodes_are_not_promised() -> None:
    near = with_stones(0.3, reference.rock(), cell=0.8)
    plan = gs.plan(near, 0.9, PEAK[:1], method=METHOD, budget=1e-3, progress=False)
    assert all(isinstance(one, gs.Rigid) for one in plan.setup.scene.materials[1:])
    assert not plan.holds
    assert any("closer than two cells" in reason for reason in plan.reasons)
    touching = with_stones(0.0, reference.rock(), cell=0.8)
    plan = gs.plan(touching, 0.9, PEAK[:1], method=METHOD, budget=1e-3, progress=False)
    assert not plan.holds and any("some touch" in reason for reason in plan.reasons)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"error": 0.0}, "error must be"),
        ({"error": 1.0}, "error must be"),
        ({"budget": 0.0}, "budget must be"),
        ({"quantities": ()}, "quantities must be"),
        ({"quantities": "run_out"}, "quantities must be"),
        ({"quantities": ("run_out", "colour")}, "quantities must be .*run_out.*got 'colour'"),
        ({"scene": "soil"}, "scene must be"),
        ({"method": "fast"}, "method must be"),
        ({"stages": "all"}, "stages must be"),
        ({"progress": "yes"}, "progress must be"),
    ],
)
def test_refused(small: gs.Scene, given: dict[str, object], message: str) -> None:
    with pytest.raises((TypeError, ValueError), match=message):
        gs.plan(**({"scene": small} | given))  # type: ignore[arg-type]
