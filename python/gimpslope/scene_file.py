"""Scene files: all that a run is made from as TOML text, in the words of the classes.

    cell = 0.1
    [outline]
    height = 9
    [materials.soil]
    density = 1800
    ...
    [[stones]]
    centre = [3.0, 2.0]
    axes = [0.86, 0.34]

Tables and keys
    cell, which is needed, points_per_cell, gravity : of `Scene`
    outline : height, crest, angle of `Outline.slope`, or vertices
    materials : a table a material, "soil" and others by any name, with the keys of `DruckerPrager`,
        or of `Elastic` or `Rigid` where law is "elastic" or "rigid". "stone" is that of stones that
        name none
    stones : a list of tables with centre, axes, angle, or vertices; and material, a name
    draw : kind "ellipses", "rounds" or "polygons" and the keys of that function in
        `gimpslope.stones`; a size law is a table with its name as law. In place of stones
    image, mesh : file, found from the directory of the scene file, and the keys of
        `gimpslope.stones.from_image` and `from_mesh`; material is a name, or a table from labels or
        groups to names; background = "none" says that nothing is around the slope. In place of
        outline and stones
    walls : left, right, bottom, top: "fixed", "roller", "free", or a table with coulomb, the
        coefficient of friction
    stages : tables gravity, settling, slide with the keys of `Gravity`, `Settling`, `Slide`
    method, recording : with the keys of `Method` and `Recording`

Unknown tables and keys, and materials that nothing uses, are refused. Angles are in degrees,
everything else in SI units.
"""

from __future__ import annotations

import inspect
import tomllib
from collections.abc import Callable, Mapping
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any, TypeVar

from . import stones as shapes
from .materials import DruckerPrager, Elastic, Material, Rigid
from .method import Method
from .outline import Outline
from .recording import Recording
from .run import Run
from .scene import Scene
from .setup import Setup
from .stages import Gravity, Settling, Slide, Stages
from .walls import Coulomb, Fixed, Free, Roller, Walls

_Table = dict[str, Any]
T = TypeVar("T")
_TABLES = ("outline", "materials", "stones", "draw", "image", "mesh")
_NUMBERS = ("cell", "points_per_cell", "gravity")
_SECTIONS = ("walls", "stages", "method", "recording")
_LAWS = {"drucker_prager": DruckerPrager, "elastic": Elastic, "rigid": Rigid}
_WALLS = {"fixed": Fixed(), "roller": Roller(), "free": Free()}
_DRAWS = {"ellipses": shapes.ellipses, "rounds": shapes.rounds, "polygons": shapes.polygons}
_SIZES = {kind.__name__: kind for kind in (shapes.Uniform, shapes.LogNormal, shapes.PowerLaw)}
_STAGES = {"gravity": Gravity, "settling": Settling, "slide": Slide}


def load(path: str | PathLike[str]) -> Setup:
    """The setup in a run file (.h5), or in a scene file, which `read` tells more of."""
    return Run(path).setup if Path(path).suffix.lower() == ".h5" else read(path)


def read(path: str | PathLike[str]) -> Setup:
    """The setup that a scene file describes.

    Raises
    ------
    FileNotFoundError, TypeError, ValueError
        If there is no such file, it is not TOML, or something in it is unknown, missing or refused;
        the error names the file and the table.
    """
    file = Path(path)
    if not file.is_file():
        raise FileNotFoundError(f"path must name a scene file, got {str(path)!r}, which is no file")
    try:
        given = tomllib.loads(file.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"{file} must be TOML, got an error: {error}") from None
    try:
        return _setup(given, file.parent)
    except (TypeError, ValueError, OSError) as error:
        raise _placed(f"{file}:", error) from error


def _setup(given: _Table, folder: Path) -> Setup:
    _known("the scene file", given, (*_NUMBERS, *_TABLES, *_SECTIONS))
    if "cell" not in given:
        raise ValueError("the scene file needs 'cell', which is missing")
    materials = _materials(given)
    outline, stones, used = _section(given, materials, folder)
    for_the_rest = {"stone"} if _some_name_none(stones) else set()
    if unused := sorted(set(materials) - used - for_the_rest - {"soil"}):
        raise ValueError(f"materials must be of the soil or of stones, got {unused} besides")
    numbers = {name: given[name] for name in _NUMBERS if name in given}
    scene = Scene(
        outline,
        materials["soil"],
        stones=stones,
        stone=materials.get("stone") if _some_name_none(stones) else None,
        walls=_in("walls", _walls, _table(given, "walls")),
        **numbers,
    )
    return Setup(
        scene,
        _in("method", partial(_made, "method", Method), _table(given, "method")),
        _in("stages", _stages, _table(given, "stages")),
        _in("recording", partial(_made, "recording", Recording), _table(given, "recording")),
    )


def _some_name_none(stones: shapes.Stones) -> bool:
    return any(stone.material is None for stone in stones)


def _materials(given: _Table) -> dict[str, Material]:
    tables = _in("materials", dict, _table(given, "materials"))
    if "soil" not in tables:
        raise ValueError(f"[materials] must have a table soil, got {sorted(tables) or 'none'}")
    return {name: _in(f"materials.{name}", _material, tables[name]) for name in tables}


def _material(keys: _Table) -> Material:
    law = keys.pop("law", "drucker_prager")
    kind: type[Material] = _choice("law", law, _LAWS)
    return _made(f"a material of law {law!r}", kind, keys)


def _section(
    given: _Table, materials: Mapping[str, Material], folder: Path
) -> tuple[Outline, shapes.Stones, set[str]]:
    """Outline, stones, and the names of the materials that the stones name."""
    parts = [name for name in ("outline", "stones", "draw", "image", "mesh") if name in given]
    for source in ("image", "mesh"):
        if source in given:
            if len(parts) > 1:
                raise ValueError(f"[{source}] must stand alone, got {', '.join(parts)}")
            return _in(source, partial(_imported, source, materials, folder), given[source])
    if "stones" in given and "draw" in given:
        raise ValueError("stones must be listed or drawn, got both [[stones]] and [draw]")
    if "outline" not in given:
        raise ValueError("[outline], [image] or [mesh] must say what slides, got none of them")
    outline = _in("outline", _outline, given["outline"])
    if "draw" in given:
        return outline, *_in("draw", partial(_drawn, outline, materials), given["draw"])
    return outline, *_listed(given.get("stones", []), materials)


def _outline(keys: _Table) -> Outline:
    return _made("outline", _shape("outline", Outline.slope, keys), keys)


def _shape(where: str, other: Callable[..., T], keys: _Table) -> Callable[..., Outline | T]:
    """What makes a shape of these keys: of vertices an Outline, without them another function."""
    if "vertices" not in keys:
        return other
    names = list(inspect.signature(other).parameters)
    if set(names) & set(keys):
        raise ValueError(
            f"{where} must have either vertices or {', '.join(names)}, got {', '.join(keys)}"
        )
    return Outline


def _listed(
    tables: list[_Table], materials: Mapping[str, Material]
) -> tuple[shapes.Stones, set[str]]:
    if not isinstance(tables, list):
        raise TypeError(f"stones must be a list of tables [[stones]], got {tables!r}")
    made = [
        _in(f"stones[{number}]", partial(_stone, materials), table)
        for number, table in enumerate(tables)
    ]
    return shapes.Stones(made), {table["material"] for table in tables if "material" in table}


def _stone(materials: Mapping[str, Material], keys: _Table) -> shapes.Stone:
    material = _named(keys.pop("material", None), materials)
    shape = _shape("a stone", shapes.Ellipse, keys)
    return shapes.Stone(_made("a stone", shape, keys), material)


def _drawn(
    outline: Outline, materials: Mapping[str, Material], keys: _Table
) -> tuple[shapes.Stones, set[str]]:
    draw = _choice("kind", keys.pop("kind", None), _DRAWS)
    name = keys.pop("material", None)
    for key, value in keys.items():
        if isinstance(value, dict):
            law = _choice(f"{key}.law", value.pop("law", None), _SIZES)
            keys[key] = _made(f"{key} of law {law.__name__}", law, value)
    material = _named(name, materials)
    return _made(draw.__name__, draw, keys, outline=outline, material=material), {name} - {None}


def _imported(
    source: str, materials: Mapping[str, Material], folder: Path, keys: _Table
) -> tuple[Outline, shapes.Stones, set[str]]:
    file = keys.pop("file", None)
    if not isinstance(file, str):
        raise ValueError(f"file must name the {source}, got {file!r}")
    path = folder / file
    names = keys.pop("material", None)
    if keys.get("background") == "none":
        keys["background"] = None
    if isinstance(names, dict):
        material: Any = {_label(label): _named(name, materials) for label, name in names.items()}
    else:
        material = _named(names, materials)
    used = set(names.values()) if isinstance(names, dict) else {names} - {None}
    load: Callable[..., Any] = shapes.from_image if source == "image" else shapes.from_mesh
    found = _made(load.__name__, load, keys, **{source: path, "material": material})
    return found.outline, found.stones, used


def _label(label: str) -> int | str:
    """TOML has no keys but text; labels and groups may be whole numbers."""
    return int(label) if label.isdecimal() else label


def _named(name: str | None, materials: Mapping[str, Material]) -> Material | None:
    return None if name is None else _choice("material", name, materials)


def _walls(keys: _Table) -> Walls:
    sides = {}
    for side, value in keys.items():
        if isinstance(value, dict):
            _known(side, value, ("coulomb",))
            if "coulomb" not in value:
                raise ValueError(f"{side} needs 'coulomb', which is missing")
            sides[side] = Coulomb(value["coulomb"])
        else:
            sides[side] = _choice(side, value, _WALLS, " or { coulomb = ... }")
    return _made("walls", Walls, sides)


def _stages(keys: _Table) -> Stages:
    made = {}
    for name, values in keys.items():
        kind = _choice("a stage", name, _STAGES)
        made[name] = _in(name, partial(_made, name, kind), values)
    return Stages(**made)


def _table(given: _Table, name: str) -> Any:
    return given.get(name, {})


def _in(where: str, make: Callable[[_Table], T], table: Any) -> T:
    """make(keys of a table), whose errors name the table."""
    if not isinstance(table, dict):
        raise TypeError(f"[{where}] must be a table, got {table!r}")
    try:
        return make(dict(table))
    except (TypeError, ValueError, OSError) as error:
        raise _placed(f"[{where}]", error) from error


def _placed(where: str, error: Exception) -> Exception:
    """An error of the same kind that says where in the file it is."""
    kinds = (FileNotFoundError, OSError, TypeError)
    kind = next((one for one in kinds if isinstance(error, one)), ValueError)
    return kind(f"{where} {error}")


def _made(where: str, make: Callable[..., T], keys: _Table, **bound: Any) -> T:
    """make(**keys, **bound), once all keys are known, none is missing and none is bound here."""
    parameters = inspect.signature(make).parameters.values()
    _known(where, keys, [one.name for one in parameters if one.name not in bound])
    needed = {one.name for one in parameters if one.default is inspect.Parameter.empty}
    if missing := sorted(needed - set(keys) - set(bound)):
        raise ValueError(f"{where} needs {', '.join(map(repr, missing))}, which is missing")
    return make(**keys, **bound)


def _known(where: str, keys: _Table, known: Any) -> None:
    if unknown := sorted(set(keys) - set(known)):
        raise ValueError(
            f"{where} has no {', '.join(map(repr, unknown))}; its keys are {', '.join(known)}"
        )


def _choice(name: str, value: Any, choices: Mapping[str, Any], more: str = "") -> Any:
    if not isinstance(value, str) or value not in choices:
        known = ", ".join(map(repr, choices)) + more
        raise ValueError(f"{name} must be one of {known}, got {value!r}")
    return choices[value]
