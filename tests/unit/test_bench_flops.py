"""The counted operations are those of the formulas: each is written down here and run on numbers
that count what is done with them."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from gimpslope.studies.bench import flops


class Number:
    """A number of no value whose operations are counted."""

    done = 0

    def _operate(self, _: object = None) -> Number:
        Number.done += 1
        return Number()

    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = _operate
    __truediv__ = __rtruediv__ = root = larger = smaller = _operate

    def __neg__(self) -> Number:
        return self


def count(formula: Callable[[], object]) -> int:
    Number.done = 0
    formula()
    return Number.done


def numbers(count: int) -> list[Number]:
    return [Number() for _ in range(count)]


def linear() -> tuple[list[Number], list[Number]]:
    x, per_cell, origin, column = numbers(4)
    room = column - (x * per_cell - origin)
    return [room, 1 - room], numbers(2)


def gimp(
    width: Number, origin: Number, inverse: Number, half_inverse: Number
) -> tuple[list[Number], Callable[[], object]]:
    """Values, and what derivatives take besides."""
    x, per_cell, column = numbers(3)
    room = column - (x * per_cell - origin)
    a = room.smaller(width)
    b = width - a
    first, last = half_inverse * (a * (2 * room - a)), half_inverse * (b * b)
    return [first, 1 - first - last, last], lambda: a * inverse - b * inverse


def ugimp() -> tuple[list[Number], Callable[[], object]]:
    return gimp(*numbers(4))


def cpgimp() -> tuple[list[Number], Callable[[], object]]:
    half_length, two_per_cell, left = numbers(3)
    width = half_length * two_per_cell
    inverse = 1 / width
    return gimp(width, left + 0.5 * width, inverse, 0.5 * inverse)


def gather(nodes: int) -> None:
    """Four sums over the nodes, row by row."""
    for _ in range(4):
        rows = [total([value * Number() for value in numbers(nodes)]) for _ in range(nodes)]
        total([row * Number() for row in rows])


def total(terms: list[Number]) -> Number:
    whole = terms[0]
    for term in terms[1:]:
        whole = whole + term
    return whole


def strain_and_volume() -> None:
    factor, half_factor, vx_x, vx_y, vy_x, vy_y, volume = numbers(7)
    xx, yy = factor * vx_x, factor * vy_y
    half_factor * (vx_y + vy_x)
    factor * (vy_x - vx_y)
    volume * (1 + (xx + yy))


def rotation() -> None:
    angle, xx, yy, xy = numbers(4)
    a = angle * angle
    cosine = 1 + a * (-1 / 2 + a * (1 / 24 + a * (-1 / 720)))
    sine = angle * (1 + a * (-1 / 6 + a * (1 / 120 + a * (-1 / 5040))))
    0.5 * (xx + yy)
    half = 0.5 * (xx - yy)
    half * cosine - xy * sine, half * sine + xy * cosine


def elastic_trial() -> None:
    lame, lame_and_shear, shear, twice_shear, centre, half, zz, xy, exx, eyy, exy = numbers(11)
    grown = exx + eyy
    centre + lame_and_shear * grown, half + shear * (exx - eyy)
    zz + lame * grown, xy + twice_shear * exy


def return_mapping() -> None:
    centre, half, zz, xy, eta, k, flow, tension, per_shear, plastic, tiny = numbers(11)
    beyond = (centre - zz) * (1 / 3)
    trial_mean = centre - beyond
    trial = ((half * half + xy * xy) + 3 * beyond * beyond).root()
    overshoot = trial + (eta * trial_mean - k)
    mean = (trial_mean - flow * overshoot).smaller(trial_mean).smaller(tension)
    root_j2 = trial.smaller(k - eta * mean)
    scale = root_j2 / (trial + tiny)
    centre, half = mean + scale * beyond, half * scale
    mean - 2 * scale * beyond, xy * scale
    centre + half, centre - half
    plastic + per_shear * (trial - root_j2)


def forces(nodes: int) -> None:
    per_cell, volume, xx, yy, xy = numbers(5)
    factor = per_cell * volume
    spread(nodes, [factor * xx, fxy := factor * xy, fxy, factor * yy])


def momentum(nodes: int) -> None:
    mass, vx, vy = numbers(3)
    spread(nodes, [mass, mass * vx, mass * vy])


def spread(nodes: int, values: list[Number]) -> None:
    """Adds values, times their weights along both axes, to as many sums at the nodes."""
    for value in values:
        for row in numbers(nodes):
            in_row = value * row
            for weight in numbers(nodes):
                Number() + in_row * weight


def move() -> None:
    keep, x, y, vx, vy, dx, dy, dvx, dvy = numbers(9)
    x + dx, y + dy, keep * vx + dvx, keep * vy + dvy


def resize() -> None:
    volume, x, y = numbers(3)
    root = volume.root()
    x * root, y * root


def node() -> None:
    mass, px, py, gx, gy, dt, keep = numbers(7)
    inverse = 1 / mass
    inverse * px, inverse * py  # before the strains
    inverse = 1 / mass
    factor = dt * inverse
    for momentum, gravity in ((px, gx), (py, gy)):
        raw = inverse * momentum
        force = (Number() + Number()) + mass * gravity
        after = raw + factor * force
        dt * after, after - keep * raw


@pytest.mark.parametrize("shape", flops.NODES)
def test_every_part(shape: str) -> None:
    n = flops.NODES[shape]
    along_axis = {"linear": linear, "ugimp": ugimp, "cpgimp": cpgimp}[shape]
    derivative = 0 if shape == "linear" else count(along_axis()[1])
    resized = count(resize) if shape == "cpgimp" else 0
    assert flops.by_part(shape) == {
        "shape functions and derivatives": 2 * (count(along_axis) + derivative),
        "velocity gradient": count(lambda: gather(n)),
        "strain and volume": count(strain_and_volume),
        "rotation": count(rotation),
        "elastic trial": count(elastic_trial),
        "return mapping": count(return_mapping),
        "forces to nodes": count(lambda: forces(n)),
        "shape functions": 2 * count(along_axis),
        "change of place and velocity": count(lambda: gather(n)),
        "move": count(move) + resized,
        "shape functions at the new place": 2 * count(along_axis),
        "mass and momentum to nodes": count(lambda: momentum(n)),
        "nodes": count(node) / 4,
    }


def test_whole_step() -> None:
    assert flops.per_point_step("ugimp") == sum(flops.by_part("ugimp").values())
    linear, common, own = map(flops.per_point_step, ("linear", "ugimp", "cpgimp"))
    assert linear < common < own


def test_unknown_shape_is_refused() -> None:
    with pytest.raises(ValueError, match=r"shape must be one of 'linear'.*, got 'cubic'"):
        flops.per_point_step("cubic")  # type: ignore[arg-type]
