"""What is measured of a problem: every choice that `Method` offers, taken from there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from itertools import chain, zip_longest
from typing import Any, Literal, get_args, get_origin, get_type_hints

from ... import _check, kernel
from ...method import DomainUpdate, Method, VolumetricStrain
from .problem import Changes, Problem
from .problems import PROBLEMS

COURANTS = (0.2, 0.8)
"""Steps shorter and longer than the default's."""

QUICK = 2
"""Grids of a quick sweep."""

ROUNDS, QUICK_ROUNDS = 3, 2
"""How often each case is run."""


Changed = tuple[tuple[str, Any], ...]
"""Changes of a method that can be compared."""


@dataclass(frozen=True)
class Case:
    """A problem on one grid with one method.

    Attributes
    ----------
    problem : by name
    cell : m
    changes : name and value of the parameters that differ from the problem's method
    model : of the stones
    """

    problem: str
    cell: float
    changes: Changed = ()
    model: str | None = None

    @property
    def method(self) -> Method:
        """Raises `ValueError` where the parameters exclude each other."""
        return replace(PROBLEMS[self.problem].method, **dict(self.changes))

    @property
    def is_default(self) -> bool:
        """Whether it is the default on its grid, with the full model of stones."""
        return not self.changes and self.model == PROBLEMS[self.problem].models[0]


@dataclass(frozen=True)
class Plan:
    """A sweep: its problems, all cases, coarse grids first, and how often each is run."""

    problems: tuple[Problem, ...]
    cases: tuple[Case, ...]
    rounds: int


def plan(names: Sequence[str] = tuple(PROBLEMS), *, quick: bool = False) -> Plan:
    """The sweep over some problems, by name; quick: `cases` says how.

    Raises `ValueError` for a name not in `PROBLEMS`.
    """
    for name in names:
        _check.one_of("problem", name, tuple(PROBLEMS))
    problems = tuple(PROBLEMS[name] for name in dict.fromkeys(names))
    some = [list(by_grid.values()) for by_grid in (_by_grid(one, quick) for one in problems)]
    rows = chain.from_iterable(zip_longest(*some, fillvalue=()))
    return Plan(problems, tuple(chain.from_iterable(rows)), QUICK_ROUNDS if quick else ROUNDS)


def _by_grid(problem: Problem, quick: bool) -> dict[float, list[Case]]:
    found: dict[float, list[Case]] = {}
    for case in cases(problem, quick=quick):
        found.setdefault(case.cell, []).append(case)
    return found


def cases(problem: Problem, *, quick: bool = False) -> list[Case]:
    """All cases of a problem, the coarse grids first; quick: the two coarsest grids, on which all
    is varied alone."""
    if quick:
        some = problem.only or [*alone(problem), *alone(problem, longer=True)[:1]]
        wanted = [(cell, changes) for cell in problem.cells[:QUICK] for changes in some]
    else:
        some = problem.only or every(problem)
        wanted = [(cell, changes) for cell in problem.cells for changes in some]
        fine = [{}, *alone(problem, longer=True)]
        wanted += [(cell, changes) for cell in problem.fine for changes in fine]
        wanted += [(cell, changes) for cell, some in problem.dear.items() for changes in some]
    found = (
        Case(problem.name, cell, tuple(changes.items()), model)
        for cell, changes in wanted
        for model in problem.models
    )
    return [case for case in found if is_allowed(case)]


def every(problem: Problem) -> list[Changes]:
    """Each choice alone at the default step and at a longer one, with which every shape function
    meets every transfer too; and a shorter step."""
    shorter, longer = ({"courant": courant} for courant in COURANTS)
    pairs: list[Changes] = [
        {**shape, **transfer, **longer} for shape in shapes()[1:] for transfer in transfers()[1:]
    ]
    return [*alone(problem), shorter, *alone(problem, longer=True), *pairs]


def alone(problem: Problem, *, longer: bool = False) -> list[Changes]:
    """The default, and each choice alone, at the default step or a longer one."""
    others: list[Changes] = [{name: one} for name, some in named(problem).items() for one in some]
    step: Changes = {"courant": COURANTS[-1]} if longer else {}
    return [{**one, **step} for one in (*shapes(), *transfers()[1:], *others)]


def shapes() -> list[Changes]:
    """The default, and what makes each other shape function."""
    found: list[Changes] = [{}]
    for shape in kernel.shapes():
        if shape == "cpgimp":
            updates = get_args(DomainUpdate)
            found += [{"shape": shape, "domain_update": update} for update in updates]
        elif shape != Method.shape:
            found.append({"shape": shape})
    return found


def transfers() -> list[Changes]:
    """The default, FLIP without PIC, and what makes each other transfer."""
    blends = {"viscosity": None, "relaxation_time": None}
    others = _choices().get("transfer", ())
    return [{}, {"alpha": 0.0, **blends}, *({"transfer": one, **blends} for one in others)]


def named(problem: Problem) -> dict[str, Sequence[str]]:
    """All other choices that go by name, but for the default: by parameter."""
    strain = problem.method.volumetric_strain
    strains = [one for one in get_args(VolumetricStrain) if one != strain]
    others = {name: some for name, some in _choices().items() if name != "transfer"}
    return {**others, "volumetric_strain": strains}


def is_allowed(case: Case) -> bool:
    """Whether the parameters go together."""
    try:
        return case.method is not None
    except ValueError:
        return False


def _choices() -> dict[str, Sequence[str]]:
    hints = get_type_hints(Method)
    return dict(_alternatives(hints))


def _alternatives(hints: dict[str, Any]) -> Iterator[tuple[str, Sequence[str]]]:
    for field in fields(Method):
        if get_origin(hint := hints[field.name]) is Literal:
            yield field.name, [one for one in get_args(hint) if one != field.default]
