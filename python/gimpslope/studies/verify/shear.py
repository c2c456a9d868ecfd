"""Simple shear of a free point, and one rigid turn of a stressed point.

With the Jaumann rate the stress of an elastic point turns with the material. Under the shear gamma

    s_xy = G sin(gamma),  s_xx = -s_yy = G (1 - cos(gamma))

(Dienes 1979, Acta Mechanica 32, 217-232), and one rigid turn gives the first stress back. In the
plane z = (s_xx - s_yy) / 2 + i s_xy, a step that shears by d turns z by the angle -d, exactly, and
then adds i G d. The sum of such steps is known as well,

    z = i G d (1 - exp(-i gamma)) / (1 - exp(-i d)),

the exact z times (d/2) / sin(d/2) exp(i d/2): an increment that arises all along its step is added
at the end of it, half a turn of the step late. An update of first order in the spin,
s + dt (w s - s w), lengthens a deviator by sqrt(1 + 4 a^2) in each step that turns it by the angle
a, without end.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ..check import Check
from .problem import Outcome, Problem

ROCK = gs.Elastic(density=2000.0, young=1e6, poisson=0.3)
FIRST = np.array([3e4, -1e4, 2e4, 1.5e4])  # xx, yy, zz, xy before the turn, Pa
SHEAR = 6.0  # gamma in the end
PUBLISHED = {100: (2.19, 5e-3), 1000: (1.082, 5e-4), 10_000: (1.0079, 5e-5)}  # and last digit / 2


def run(full: bool) -> Outcome:
    """A turn in 100 to 10,000 steps, and shear in steps ever finer."""
    steps = np.array([50, 100, 200, 400, 800, 1600] if full else [100, 200])
    shear = np.array([sheared(n, SHEAR)[0] for n in steps])
    exact = exact_shear(SHEAR)
    errors = np.abs(shear - exact) / abs(exact)
    order = float(np.log2(errors[-2] / errors[-1]))
    half_turn = SHEAR / int(steps[-1]) / 2
    exact_turn = {n: np.abs(turned(n) - FIRST).max() / deviator(FIRST) for n in PUBLISHED}
    first_order = {n: deviator(turned_at_first_order(n)) / deviator(FIRST) for n in PUBLISHED}
    checks = [
        Check.at_most(
            "rigid turn, change of the stress, parts of the deviator",
            bound=1e-12,
            got=max(exact_turn.values()),
            why="exact rotation: rounding of at most 10,000 steps",
        ),
        *(
            Check.near(
                f"deviator after a turn in {n} steps, first-order spin (not the kernel's)",
                expected=published,
                got=first_order[n],
                within=within,
                why="published, to half of the last digit; (1 + 4 a^2)^(n/2), a = 2 pi / n",
            )
            for n, (published, within) in PUBLISHED.items()
        ),
        Check.at_most(
            "simple shear against the sum of its steps, parts of G",
            bound=1e-12,
            got=float(np.abs(shear - sum_of_steps(steps)).max() / ROCK.shear_modulus),
            why="each step is exact: rounding",
        ),
        Check.near(
            f"simple shear to gamma = {SHEAR:g} in {steps[-1]} steps, relative error",
            expected=half_turn,
            got=float(errors[-1]),
            within=half_turn**3,
            why="half the turn of a step d/2, but for (d/2)^3 / 18",
        ),
        Check.near(
            "simple shear, order of the error in the step",
            expected=1.0,
            got=order,
            within=1e-3,
            why="d/2 + O(d^3)",
            order=order,
        ),
    ]
    return Outcome(checks, draw(exact_turn, first_order))


def turned(steps: int) -> FloatArray:
    """Stress after one rigid turn in the kernel, Pa."""
    spin = 2 * np.pi * np.array([[[0.0, -1.0], [1.0, 0.0]]])
    return gs.kernel.update_stress(ROCK, FIRST[None], spin, 1 / steps, steps).stress.ravel()


def turned_at_first_order(steps: int) -> FloatArray:
    """Stress after one rigid turn by s + dt (w s - s w), Pa."""
    spin = 2 * np.pi / steps * np.array([[0.0, -1.0], [1.0, 0.0]])
    stress = FIRST[[0, 3, 3, 1]].reshape(2, 2)
    for _ in range(steps):
        stress = stress + spin @ stress - stress @ spin
    return np.array([stress[0, 0], stress[1, 1], FIRST[2], stress[0, 1]])


def sheared(steps: int, shear: npt.ArrayLike) -> npt.NDArray[np.complex128]:
    """z of points after simple shear in the kernel, Pa."""
    gradient = np.zeros((np.size(shear), 2, 2))
    gradient[:, 0, 1] = shear
    start = np.zeros((len(gradient), 4))
    return in_plane(gs.kernel.update_stress(ROCK, start, gradient, 1 / steps, steps).stress)


def exact_shear(shear: npt.ArrayLike) -> npt.NDArray[np.complex128]:
    """z under the Jaumann rate, Pa."""
    return np.asarray(ROCK.shear_modulus * (1 - np.exp(-1j * np.asarray(shear))))


def sum_of_steps(steps: npt.NDArray[np.int_]) -> npt.NDArray[np.complex128]:
    """z to which exact steps add up, Pa."""
    step = SHEAR / steps
    return np.asarray(1j * step * exact_shear(SHEAR) / (1 - np.exp(-1j * step)))


def in_plane(stress: FloatArray) -> npt.NDArray[np.complex128]:
    """z = (s_xx - s_yy) / 2 + i s_xy of stresses (..., 4), Pa."""
    return np.asarray((stress[..., 0] - stress[..., 1]) / 2 + 1j * stress[..., 3])


def deviator(stress: FloatArray) -> float:
    """|z| of one stress, Pa."""
    return float(np.abs(in_plane(stress)))


def draw(exact_turn: dict[int, float], first_order: dict[int, float]) -> Figure:
    """Stress over shear, and error of the deviator over steps a turn."""
    figure = Figure(figsize=(8.0, 3.4), layout="constrained")
    left, right = figure.subplots(1, 2)
    gamma = np.linspace(0, SHEAR, 200)
    exact = exact_shear(gamma) / ROCK.shear_modulus
    left.plot(gamma, exact.real, "k-", gamma, exact.imag, "k-", linewidth=0.8)
    dots = sheared(1000, gamma[::8]) / ROCK.shear_modulus
    left.plot(gamma[::8], dots.real, "C0o", markersize=4, label="$s_{xx}/G$")
    left.plot(gamma[::8], dots.imag, "C1s", markersize=4, label="$s_{xy}/G$")
    left.plot([], [], "k-", linewidth=0.8, label="exact")
    left.set(xlabel="shear $\\gamma$", ylabel="stress / G", ylim=(-1.2, 3.2))
    left.legend(loc="upper center", ncols=3)
    steps = np.array(list(PUBLISHED))
    grown = np.array(list(first_order.values())) - 1
    right.loglog(steps, (1 + 16 * np.pi**2 / steps**2) ** (steps / 2) - 1, "k-", linewidth=0.8)
    right.loglog(steps, grown, "C3^", label="first order in the spin")
    right.loglog(steps, list(exact_turn.values()), "C0o", label="exact rotation")
    right.set(xlabel="steps a turn", ylabel="error of the deviator", ylim=(1e-17, 1e4))
    right.legend(loc="upper right")
    return figure


PROBLEM = Problem("shear", "Simple shear and a rigid turn", run)
