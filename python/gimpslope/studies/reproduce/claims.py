"""What the paper says of its slopes, each with what it means in figures of the runs.

A claim that gives a number is met within a tolerance that it states; words without a number are
given one here, said in brackets.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from .. import reference
from .judging import (
    SLOPES,
    SOIL,
    STONES,
    Draws,
    Form,
    Judgement,
    Part,
    alike,
    between,
    judgement,
    near,
    ordered,
    ratio,
)

_PAPER = reference.PAPER
_SHARE, _COUNT, _RATIO = Form(1, "%", 100.0), Form(0), Form(3)
_SECONDS, _SPEED, _ENERGY, _MASS = Form(2, "s"), Form(2, "m/s"), Form(1, "kJ/m"), Form(1, "t/m")
_METRES, _MILLIMETRES = Form(2, "m"), Form(0, "mm")
_FARTHEST_WITH_STONES = _PAPER["arbitrary"]["max_displacement_total"]
_ANY = math.inf


class Claim(NamedTuple):
    """What the paper says, where, and the parts of it that must all hold."""

    section: str
    text: str
    parts: tuple[Part, ...]


def judge(draws: Draws, spread: Mapping[str, float]) -> list[tuple[Claim, Judgement]]:
    """Every claim with its judgement, in the order of the paper, as far as it is about the slopes
    there are; `spread`: the share by which chance moves each figure from draw to draw."""
    return [(claim, judgement(claim.parts, draws, spread)) for claim in CLAIMS]


CLAIMS = (
    Claim(
        "kinetic energy",
        "All four slides last the same time, about 4 s (within 15 %).",
        (
            alike("rest_time", _SECONDS, 0.15, SLOPES),
            near("rest_time", _SECONDS, 4, 0.6, SLOPES),
        ),
    ),
    Claim(
        "kinetic energy",
        "The slope with round stones accelerates for the shortest time, that with arbitrary ones "
        "for the longest.",
        (ordered("peak_time", _SECONDS, "arbitrary", (SOIL, "oval"), "round"),),
    ),
    Claim(
        "kinetic energy",
        "The slope with round stones slows down for the longest time, that with arbitrary ones for "
        "the shortest.",
        (ordered("deceleration", _SECONDS, "round", (SOIL, "oval"), "arbitrary"),),
    ),
    Claim(
        "kinetic energy",
        "The soil slope has the highest peak, then arbitrary, round and oval stones.",
        (ordered("peak_energy", _ENERGY, SOIL, *STONES),),
    ),
    Claim(
        "kinetic energy",
        "The peak of the soil slope is 2.5 times that with arbitrary stones (within 15 %).",
        (ratio("peak_energy", _ENERGY, SOIL, "arbitrary", 2.5, 0.15),),
    ),
    Claim(
        "kinetic energy",
        "The soil slope is lighter than those with stones.",
        (ordered("mass", _MASS, STONES, SOIL),),
    ),
    Claim(
        "speed",
        "At 0.5 s the fastest points of all slopes are equally fast (within 5 %).",
        (alike("early_speed", _SPEED, 0.05, SLOPES),),
    ),
    Claim(
        "speed",
        "At the peak the soil slope is the fastest, above 3 m/s, and that with oval stones the "
        "slowest.",
        (
            ordered("peak_speed", _SPEED, SOIL, ("arbitrary", "round"), "oval"),
            between("peak_speed", _SPEED, _PAPER[SOIL]["speed_at_peak"], _ANY, (SOIL,)),
        ),
    ),
    Claim(
        "speed",
        "At the peak most moves fast (here: share of the mass above 1 m/s) in the soil slope, then "
        "with arbitrary stones, least with oval ones.",
        (ordered("fast_share", _SHARE, SOIL, "arbitrary", ("round",), "oval"),),
    ),
    Claim(
        "speed",
        "At 3.5 s the slope with arbitrary stones is the fastest, at 2 m/s (within 15 %).",
        (
            ordered("late_speed", _SPEED, "arbitrary", (SOIL, "round", "oval")),
            near("late_speed", _SPEED, 2, 0.3, ("arbitrary",)),
        ),
    ),
    Claim(
        "speed",
        "And only its front is above 1 m/s then (here: less than 1 % of its mass is so and not in "
        "the front quarter).",
        (between("late_rear", _SHARE, -_ANY, 0.01, ("arbitrary",)),),
    ),
    Claim(
        "plastic zone",
        "The plastic zone of the soil slope is one, from 1 s to 5 s.",
        tuple(near(f"{time}_bands", _COUNT, 1, 0.5, (SOIL,)) for time in ("early", "peak", "late")),
    ),
    Claim(
        "plastic zone",
        "In slopes with stones several plastic bands interlace (here: at 1 s they enclose more "
        "islands than in the soil slope).",
        (ordered("early_islands", _COUNT, STONES, SOIL),),
    ),
    Claim(
        "plastic zone",
        "The bands go around the stones (here: a tenth as much of the stones is plastic as of the "
        "soil, or less).",
        (between("stone_over_soil", _RATIO, -_ANY, 0.1, STONES),),
    ),
    Claim(
        "plastic zone",
        "Among slopes with stones most soil yields with arbitrary, least with oval ones.",
        (ordered("plastic_soil", _SHARE, "arbitrary", "round", "oval"),),
    ),
    Claim(
        "plastic zone",
        "With oval stones much of the bottom stays without plastic strain (here: more of the "
        "lowest 2 m than in any other slope).",
        (ordered("bottom_intact", _SHARE, "oval", (SOIL, "arbitrary", "round")),),
    ),
    Claim(
        "displacement",
        "The soil slope moves farthest: 9.3 m, 8.9 m horizontally and 5.4 m vertically (labels put "
        "right; within 0.2 m).",
        (
            ordered("total", _METRES, SOIL, STONES),
            near("total", _METRES, _PAPER[SOIL]["max_displacement_total"], 0.2, (SOIL,)),
            near("horizontal", _METRES, _PAPER[SOIL]["max_displacement_horizontal"], 0.2, (SOIL,)),
            near("vertical", _METRES, _PAPER[SOIL]["max_displacement_vertical"], 0.2, (SOIL,)),
        ),
    ),
    Claim(
        "displacement",
        "The largest horizontal displacement is nearly the total one (labels put right; at least "
        "90 % of it).",
        (between("sideways", _SHARE, 0.9, _ANY),),
    ),
    Claim(
        "displacement",
        "With oval stones the slope moves least, then with round ones, and of the three farthest "
        "with arbitrary ones, 8.7 m (within 0.2 m).",
        (
            ordered("total", _METRES, *STONES),
            near("total", _METRES, _FARTHEST_WITH_STONES, 0.2, ("arbitrary",)),
        ),
    ),
    Claim(
        "displacement",
        "With round and oval stones most moves by less than 2 m, more of it than in the other "
        "slopes.",
        (
            between("near_share", _SHARE, 0.5, _ANY, ("round", "oval")),
            ordered("near_share", _SHARE, ("round", "oval"), (SOIL, "arbitrary")),
        ),
    ),
    Claim(
        "displacement",
        "What moves by more than 4 m is in the front (here: 75 % of it in the front quarter).",
        (between("far_front", _SHARE, 0.75, _ANY),),
    ),
    Claim(
        "final shape",
        "The surface is smoothest in the soil slope, then with round and oval stones, and uneven "
        "with arbitrary ones.",
        (ordered("roughness", _MILLIMETRES, "arbitrary", ("round", "oval"), SOIL),),
    ),
    Claim(
        "conclusion",
        "The homogeneous slope slides out farther than those with stones.",
        (ordered("run_out", _METRES, SOIL, STONES),),
    ),
    Claim(
        "conclusion",
        "With large stones less soil yields than with small ones (here: round and oval against "
        "arbitrary ones, among which are small ones).",
        (ordered("plastic_soil", _SHARE, "arbitrary", ("round", "oval")),),
    ),
)
