"""Random trial stresses come back to the yield surface.

In the plane of (p / sqrt K, sqrt(J2) / sqrt G) distance squared is twice the elastic energy of the
difference of two stresses, and the admissible stresses are a convex wedge: under the cone
sqrt(J2) = xi c - eta p and left of the tension limit. With associated flow a trial stress returns
to the closest point of the wedge (Simo & Hughes 1998, chapter 3), found here by geometry on its
two edges. Without dilation the pressure stays and the deviator shrinks to the cone; beyond the
tension limit, at most the apex c / tan(phi), the pressure is cut back. The plastic strain
C^-1 (trial - returned) flows along the two edges' normals, tilted by etabar, and only along those
of edges that are reached; the returned stress does the work on it that is dissipated.
"""

from __future__ import annotations

from typing import NamedTuple, get_args

import numpy as np
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ...materials import Cone
from ..check import Check
from .problem import Outcome, Problem

FRICTION, COHESION = 22.0, 1e3  # degrees, Pa
CUT_OFF = 600.0  # largest mean stress, Pa; the apex lies at 2475 Pa
SPREAD = 5e3  # of the trial stresses, Pa
EXACT = 1e-12  # rounding, in parts of SPREAD


class Return(NamedTuple):
    """Trial and returned stresses of a material: columns of p and sqrt(J2), Pa, (n, 2); and how far
    a deviator has left its direction, Pa."""

    material: gs.DruckerPrager
    trial: FloatArray
    after: FloatArray
    turned: float


def run(full: bool) -> Outcome:
    """All cones and three dilation angles, with the apex and with a cut-off."""
    trial = stresses(50_000 if full else 5_000)
    cones: tuple[Cone, ...] = get_args(Cone) if full else ("plane_strain_associated",)
    returns = [
        mapped(gs.DruckerPrager(1800.0, 1e6, 0.3, FRICTION, COHESION, psi, cone, cut_off), trial)
        for cone in cones
        for psi in (0.0, 9.0, FRICTION)
        for cut_off in (None, CUT_OFF)
    ]
    zero = [case for case in returns if case.material.dilation == 0]
    associated = [case for case in returns if case.material.dilation == FRICTION]
    errors = {
        "beyond the yield surface": max(map(overshoot, returns)),
        "turn of the deviator": max(case.turned for case in returns),
        "departure from the flow rule": max(map(flow_error, returns)),
        "distance from the closest point, psi = phi": max(map(closest_point_error, associated)),
        "departure from the closed form, psi = 0": max(map(closed_form_error, zero)),
    }
    checks = [
        Check.at_least(
            "stresses in the rarest regime, %",
            bound=1.0,
            got=100 * float(shares(associated[1]).min()),
            why="inside, cone, cut-off and the edge of both: each has to be tried",
        ),
        *(
            Check.at_most(
                f"{what}, parts of 5 kPa", bound=EXACT, got=error / SPREAD, why="exact: rounding"
            )
            for what, error in errors.items()
        ),
        Check.at_least(
            "least dissipation, parts of (5 kPa)^2 / G",
            bound=-EXACT,
            got=min(map(least_dissipation, returns)) / SPREAD**2,
            why="second law, which psi <= phi grants; rounding",
        ),
    ]
    return Outcome(checks, draw(zero[1], associated[1]))


def stresses(n: int) -> FloatArray:
    """Random xx, yy, zz, xy in all regimes, Pa, shape (n, 4)."""
    random = np.random.default_rng(7)
    stress = SPREAD * random.uniform(0, 1, (n, 1)) * random.standard_normal((n, 4))
    stress[:, :3] += SPREAD * random.uniform(-3, 1.5, (n, 1))
    return np.asarray(stress)


def mapped(material: gs.DruckerPrager, trial: FloatArray) -> Return:
    after = gs.kernel.return_mapping(material, trial).stress
    before, then = deviator(trial), deviator(after)
    root_before, root_then = (in_plane(stress)[:, 1:] for stress in (trial, after))
    turned = np.abs(then - before * root_then / root_before).max()
    return Return(material, in_plane(trial), in_plane(after), float(turned))


def deviator(stress: FloatArray) -> FloatArray:
    mean = stress[:, :3].mean(axis=1, keepdims=True)
    return np.asarray(stress - mean * (1, 1, 1, 0))


def in_plane(stress: FloatArray) -> FloatArray:
    root = np.sqrt(deviator(stress) ** 2 @ (0.5, 0.5, 0.5, 1.0))
    return np.stack([stress[:, :3].mean(axis=1), root], axis=1)


def room(material: gs.DruckerPrager, stress: FloatArray) -> FloatArray:
    """How far stresses lie under the cone and below the tension limit, Pa, (n, 2)."""
    eta, xi, _ = material.cone_coefficients
    mean, root = stress.T
    return np.stack([xi * COHESION - eta * mean - root, material.tension_limit - mean], axis=1)


def shares(case: Return) -> FloatArray:
    """Shares of the regimes: inside, cone, cut-off, edge of both."""
    reached = room(case.material, case.after) < EXACT * SPREAD
    return np.bincount(reached @ (1, 2), minlength=4) / len(reached)


def overshoot(case: Return) -> float:
    return -float(room(case.material, case.after).min())


def flow_error(case: Return) -> float:
    """Of the multipliers, never negative and zero where there is room, as stresses, Pa."""
    mean, root = (case.trial - case.after).T
    tilt = case.material.cone_coefficients[2] * squeeze(case.material)
    multipliers = np.stack([root, mean - tilt * root], axis=1)
    return float(np.abs(np.minimum(multipliers, room(case.material, case.after))).max())


def squeeze(material: gs.DruckerPrager) -> float:
    """K / G."""
    return material.bulk_modulus / material.shear_modulus


def closest_point_error(case: Return) -> float:
    """Distance from the closest point of the wedge, Pa."""
    eta, limit = case.material.cone_coefficients[0], case.material.tension_limit
    scale = np.array([squeeze(case.material) ** -0.5, 1.0])
    point = case.trial * scale
    corner = np.array([limit, room(case.material, np.array([[limit, 0.0]]))[0, 0]]) * scale
    along = np.array([-1.0, eta]) * scale
    along /= np.hypot(*along)
    on_cone = corner + ((point - corner) @ along).clip(0.0)[:, None] * along
    on_limit = np.stack([np.full(len(point), corner[0]), point[:, 1].clip(0.0, corner[1])], axis=1)
    nearer = np.hypot(*(point - on_cone).T) < np.hypot(*(point - on_limit).T)
    closest = np.where(nearer[:, None], on_cone, on_limit)
    inside = room(case.material, case.trial).min(axis=1) > 0
    closest[inside] = point[inside]
    return float(np.hypot(*(case.after * scale - closest).T).max())


def closed_form_error(case: Return) -> float:
    """From the pressure kept or cut back and the deviator shrunk to the cone, Pa."""
    mean = case.trial[:, 0].clip(None, case.material.tension_limit)
    on_axis = np.stack([mean, 0 * mean], axis=1)
    root = np.minimum(case.trial[:, 1], room(case.material, on_axis)[:, 0].clip(0.0))
    return float(np.abs(case.after - np.stack([mean, root], axis=1)).max())


def least_dissipation(case: Return) -> float:
    """Least work of the returned stress on the plastic strain, times G, Pa2."""
    work = case.after * (case.trial - case.after) @ (1 / squeeze(case.material), 1.0)
    return float(work.min())


def draw(*cases: Return) -> Figure:
    """Some of the trial stresses and where they go."""
    figure = Figure(figsize=(8.0, 4.0), layout="constrained")
    for ax, case in zip(figure.subplots(1, 2, sharey=True), cases, strict=True):
        limit = case.material.tension_limit
        top, corner = room(case.material, np.array([[-15e3, 0.0], [limit, 0.0]]))[:, 0]
        surface = np.array([[-15e3, top], [limit, corner], [limit, 0.0]])
        scale = np.array([squeeze(case.material) ** -0.5, 1.0]) / 1e3
        trial, after = case.trial[:80] * scale, case.after[:80] * scale
        ax.plot(*(surface * scale).T, "k-", label="yield surface")
        ax.plot(*np.stack([trial, after], axis=1).T, "C7-", linewidth=0.6)
        ax.plot(*trial.T, "C0.", label="trial stress")
        ax.plot(*after.T, "C3.", label="returned stress")
        ax.set(xlabel="mean stress $p\\sqrt{G/K}$ (kPa)", xlim=(-9, 6), ylim=(0, 9))
        ax.set(title=f"dilation angle {case.material.dilation:g}°", aspect="equal")
    figure.axes[0].set_ylabel("$\\sqrt{J_2}$ (kPa)")
    figure.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


PROBLEM = Problem("return_mapping", "Return mapping", run)
