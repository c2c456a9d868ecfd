"""Walls, method and stages: defaults, what is refused, and what reaches the kernel."""

import json
import math

import numpy as np
import pytest

from gimpslope.materials import DruckerPrager
from gimpslope.method import Method
from gimpslope.stages import Gravity, Settling, Slide, Stages
from gimpslope.walls import Coulomb, Fixed, Free, Roller, Walls


def test_walls_hold_left_and_bottom_unless_told():
    assert Walls() == Walls(left=Fixed(), right=Free(), bottom=Fixed(), top=Free())


def test_kinds_of_wall_differ():
    assert len({Free(), Roller(), Fixed(), Coulomb(0.0), Coulomb(0.2)}) == 5


def test_walls_for_the_kernel_are_in_order():
    walls = Walls(left=Roller(), right=Fixed(), bottom=Coulomb(0.2), top=Free())
    assert walls.to_core((0.0, 11.0, -1.0, 9.0)) == [
        ("roller", 0.0, 0.0),
        ("fixed", 0.0, 11.0),
        ("coulomb", 0.2, -1.0),
        ("free", 0.0, 9.0),
    ]


@pytest.mark.parametrize(
    ("value", "error"),
    [(-0.1, ValueError), (math.nan, ValueError), (True, TypeError), ("rough", TypeError)],
)
def test_coulomb_refuses(value, error):
    with pytest.raises(error, match=f"friction must be a finite number >= 0, got .*{value}"):
        Coulomb(value)


@pytest.mark.parametrize("side", ["left", "right", "bottom", "top"])
@pytest.mark.parametrize("value", [None, "fixed", Fixed, 0.2])
def test_walls_refuse_what_is_no_wall(side, value):
    with pytest.raises(TypeError, match=rf"^{side} must be Free\(\), .* got "):
        Walls(**{side: value})


SOIL = DruckerPrager(density=1800, young=30e6, poisson=0.33, friction=22, cohesion=1e3)


@pytest.mark.parametrize(
    ("materials", "strain"),
    [
        ([SOIL], "cell_average"),
        ([SOIL.elastic()], "point"),
        ([SOIL.elastic(), SOIL], "cell_average"),
    ],
)
def test_strains_are_averaged_where_a_material_yields(materials, strain):
    assert Method().of(materials).volumetric_strain == strain
    for given in ("point", "cell_average"):
        chosen = Method(volumetric_strain=given)
        assert chosen.of(materials) == chosen


def test_method_has_the_defaults_of_the_study():
    assert Method().of([SOIL.elastic()]).to_core() == {
        "shape": "ugimp",
        "precision": "double",
        "scheme": "usf",
        "transfer": "flip",
        "order": 1,
        "blend": ("alpha", 0.01),
        "time_step": ("courant", 0.4),
        "domain_update": "none",
        "volume_update": "linear",
        "volumetric_strain": "point",
        "threads": 1,
        "allow_unstable": False,
        "ledger": False,
    }


@pytest.mark.parametrize(
    ("given", "blend"),
    [
        ({"alpha": 0}, ("alpha", 0.0)),
        ({"alpha": 1}, ("alpha", 1.0)),
        ({"viscosity": 0.5625}, ("viscosity", 0.5625)),
        ({"viscosity": 0}, ("viscosity", 0.0)),
        ({"relaxation_time": np.float32(0.5)}, ("relaxation_time", 0.5)),
        ({"transfer": "apic"}, ("alpha", 1.0)),
        ({"transfer": "xpic", "order": 3}, ("alpha", 1.0)),
    ],
)
def test_blend(given, blend):
    assert Method(**given).blend == blend


@pytest.mark.parametrize(
    ("given", "step"),
    [
        ({"courant": 1}, ("courant", 1.0)),
        ({"time_step": 1e-4}, ("fixed", 1e-4)),
        ({"courant": 1.5, "allow_unstable": True}, ("courant", 1.5)),
    ],
)
def test_step(given, step):
    assert Method(**given).step == step


@pytest.mark.parametrize(
    ("given", "update"),
    [
        ({"shape": "linear"}, "none"),
        ({"shape": "cpgimp"}, "jacobian"),
        ({"shape": "cpgimp", "domain_update": "stretch"}, "stretch"),
    ],
)
def test_domain_update(given, update):
    assert Method(**given).to_core()["domain_update"] == update


@pytest.mark.parametrize(
    ("name", "value", "error"),
    [
        ("shape", "gimp", ValueError),
        ("shape", None, TypeError),
        ("scheme", "usp", ValueError),
        ("transfer", "tpic", ValueError),
        ("transfer", 2, TypeError),
        ("order", 2, ValueError),
        ("alpha", -0.01, ValueError),
        ("alpha", 1.01, ValueError),
        ("alpha", math.nan, ValueError),
        ("alpha", True, TypeError),
        ("viscosity", -1.0, ValueError),
        ("relaxation_time", 0.0, ValueError),
        ("courant", 0.0, ValueError),
        ("courant", 1.1, ValueError),
        ("courant", math.inf, ValueError),
        ("time_step", 0.0, ValueError),
        ("time_step", "1 ms", TypeError),
        ("domain_update", "jacobian", ValueError),
        ("domain_update", "none", ValueError),
        ("volume_update", "quadratic", ValueError),
        ("volumetric_strain", "nodal", ValueError),
        ("volumetric_strain", True, TypeError),
        ("ledger", 1, TypeError),
        ("threads", 0, ValueError),
        ("threads", 1.0, TypeError),
        ("threads", True, TypeError),
        ("allow_unstable", 1, TypeError),
    ],
)
def test_method_refusal_names_parameter_and_value(name, value, error):
    with pytest.raises(error, match=f"^{name} must be .*got .*{value}"):
        Method(**{name: value})


@pytest.mark.parametrize(
    "given",
    [
        {"alpha": 0.01, "viscosity": 0.5},
        {"viscosity": 0.5, "relaxation_time": 2.0},
        {"alpha": 0.0, "relaxation_time": 2.0},
        {"courant": 0.4, "time_step": 1e-4},
    ],
)
def test_method_refuses_two_ways_of_giving_one_thing(given):
    shown = ", ".join(f"{name}={value}" for name, value in given.items())
    with pytest.raises(ValueError, match=f"at most one of .* got {shown}"):
        Method(**given)


@pytest.mark.parametrize(("given", "order"), [({}, 2), ({"order": 1}, 1), ({"order": 100}, 100)])
def test_order_of_xpic(given, order):
    assert Method(transfer="xpic", **given).to_core()["order"] == order


@pytest.mark.parametrize(
    ("given", "refusal"),
    [
        ({"transfer": "apic", "order": 2}, "order must be None unless .*'xpic', got 2 .*'apic'"),
        ({"transfer": "xpic", "order": 0}, "order must be .*got 0"),
        ({"transfer": "xpic", "order": 101}, "order must be at most 100, got 101"),
        ({"transfer": "apic", "alpha": 0.5}, "alpha must be None .*'flip', got 0.5 .*'apic'"),
        ({"transfer": "xpic", "viscosity": 0.5}, "viscosity must be None .*, got 0.5 .*'xpic'"),
        ({"transfer": "apic", "shape": "linear"}, "transfer must be .*'linear'.*, got 'apic'"),
    ],
)
def test_members_that_do_not_go_together_are_refused(given, refusal):
    with pytest.raises(ValueError, match=refusal):
        Method(**given)


def test_stages_find_a_static_solution_unless_told():
    settling = Settling(unbalanced=2e-3, limit=20.0, damping="kinetic", courant=0.9)
    slide = Slide(duration=10.0, rest_ratio=0.0, rest_change=None)
    assert Stages() == Stages(Gravity(ramp=0.2), settling, slide)


def test_criteria_of_settling():
    by_ratio, local, both = (
        Settling(1e-6),
        Settling(damping="local"),
        Settling(1e-6, unbalanced=0.1),
    )
    assert (by_ratio.ratio, by_ratio.unbalanced, by_ratio.courant) == (1e-6, None, None)
    assert (local.ratio, local.unbalanced, local.courant) == (1e-6, None, None)
    assert (both.ratio, both.unbalanced, both.courant) == (1e-6, 0.1, 0.9)
    assert Settling(1e-6, courant=0.5).courant == 0.5


def test_stages_recorded_before_there_were_static_ones_stay_what_they_were():
    recorded = {
        "type": "Stages",
        "gravity": {"type": "Gravity", "ramp": 0.5},
        "settling": {
            "type": "Settling",
            "ratio": 1e-06,
            "limit": 20.0,
            "damping": "kinetic",
            "coefficient": None,
        },
        "slide": {
            "type": "Slide",
            "duration": 4.0,
            "rest_ratio": 0.0,
            "rest_speed": None,
            "rest_time": 0.1,
        },
    }
    assert Stages.from_dict(recorded) == Stages(Gravity(0.5), Settling(1e-6), Slide(4.0))


def test_slide_until_rest():
    slide = Slide(4.0, rest_ratio=0.5, rest_speed=1.0).until_rest()
    assert slide == Slide(4.0, rest_ratio=1e-2, rest_time=0.5, rest_change=2e-3)


@pytest.mark.parametrize(
    ("settling", "arguments"),
    [
        (Settling(), (0.0, True)),
        (Settling(damping="local"), (0.7, False)),
        (Settling(damping="local", coefficient=0.2), (0.2, False)),
    ],
)
def test_damping_for_the_kernel(settling, arguments):
    assert settling.to_core() == arguments


@pytest.mark.parametrize(
    ("stage", "name", "value", "error"),
    [
        (Gravity, "ramp", -1.0, ValueError),
        (Gravity, "ramp", math.nan, ValueError),
        (Settling, "ratio", 0.0, ValueError),
        (Settling, "ratio", 1.0, ValueError),
        (Settling, "limit", 0.0, ValueError),
        (Settling, "damping", "viscous", ValueError),
        (Settling, "damping", None, TypeError),
        (Settling, "coefficient", 0.5, ValueError),
        (Settling, "unbalanced", 0.0, ValueError),
        (Settling, "unbalanced", 1.0, ValueError),
        (Settling, "courant", 0.0, ValueError),
        (Settling, "courant", 1.1, ValueError),
        (Settling, "courant", True, TypeError),
        (Slide, "duration", 0.0, ValueError),
        (Slide, "duration", True, TypeError),
        (Slide, "rest_ratio", -0.1, ValueError),
        (Slide, "rest_ratio", 1.0, ValueError),
        (Slide, "rest_speed", 0.1, ValueError),
        (Slide, "rest_time", -0.1, ValueError),
        (Slide, "rest_change", 0.1, ValueError),
        (Slide, "rest_change", 0.0, ValueError),
        (Stages, "slide", 10.0, TypeError),
        (Stages, "gravity", "Slide", TypeError),
    ],
)
def test_stage_refusal_names_parameter_and_value(stage, name, value, error):
    with pytest.raises(error, match=f"^{name} must be .*got .*{value}"):
        stage(**{name: value})


def test_local_damping_has_no_moments_of_rest():
    with pytest.raises(ValueError, match=r"unbalanced must be None unless .*, got 0\.1 with"):
        Settling(damping="local", unbalanced=0.1)


def test_change_at_rest_needs_a_time():
    with pytest.raises(ValueError, match="rest_time must be a finite number > 0, got 0"):
        Slide(rest_ratio=0.1, rest_change=0.1, rest_time=0)


@pytest.mark.parametrize("coefficient", [0, 1, -0.5, math.nan])
def test_local_damping_refuses(coefficient):
    with pytest.raises(ValueError, match=rf"coefficient must be .*\(0, 1\), got {coefficient}"):
        Settling(damping="local", coefficient=coefficient)


@pytest.mark.parametrize(
    "record",
    [
        Walls(right=Coulomb(0.2), top=Roller()),
        Method(shape="cpgimp", viscosity=0.1, time_step=1e-5, threads=3, allow_unstable=True),
        Method(shape="quadratic_bspline", scheme="musl", transfer="xpic", order=3),
        Stages(Gravity(0), Settling(damping="local", coefficient=0.5), Slide(4.0, 1e-3)),
        Stages(settling=Settling(unbalanced=0.1, courant=0.5), slide=Slide().until_rest()),
    ],
    ids=lambda record: type(record).__name__,
)
def test_round_trip_through_json(record):
    assert type(record).from_dict(json.loads(json.dumps(record.to_dict()))) == record


def test_misspelt_key_deep_inside_is_refused():
    data = Stages().to_dict()
    data["settling"]["limits"] = 3.0
    with pytest.raises(ValueError, match="Settling has no 'limits'; its keys are ratio, limit"):
        Stages.from_dict(data)
