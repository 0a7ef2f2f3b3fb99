"""An oil by its ISO viscosity grade or by two viscosities.

What such a table leaves out is typical of its kind, and its source says so.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict
from pydantic_core import PydanticCustomError

from epicyclic.oil.oil import OilDensity
from epicyclic.schema.fields import option
from epicyclic.units import KinematicViscosity

GOLD: dict[str, tuple[float, float, str]] = {
    "mineral": (9.904, 0.1390, "mineral oil"),
    "pao": (7.382, 0.1335, "polyalphaolefin"),
    "ester": (6.605, 0.1360, "ester"),
    "pag": (5.489, 0.1485, "polyglycol"),
    "atf": (9.904, 0.1390, "mineral oil, assumed for transmission fluids"),
}
"""s, t and name of base oils; Gold et al. (2001), second hand; see `GoldLaw`."""

DENSITY = {"mineral": 880, "pao": 850, "ester": 930, "pag": 1050, "atf": 850}
"""Usual densities at 15 degC; estimates. [kg/m^3]"""

GRADES = (2, 3, 5, 7, 10, 15, 22, 32, 46, 68, 100, 150, 220, 320, 460, 680, 1000, 1500, 2200, 3200)
"""Grades of ISO 3448: middle of their viscosity at 40 degC in mm^2/s. Those below 10 have
2.2, 3.2, 4.6 and 6.8."""
_SMALL = {2: 2.2, 3: 3.2, 5: 4.6, 7: 6.8}


class ShortOil(BaseModel):
    """An oil by its ISO viscosity grade or two viscosities, and its kind."""

    model_config = ConfigDict(extra="allow", defer_build=True)

    kind: Literal["mineral", "pao", "ester", "pag", "atf"]
    iso_vg: int | None = option("Grade of ISO 3448.")
    viscosity_40: KinematicViscosity | None = option("At 40 °C.")
    viscosity_100: KinematicViscosity | None = option("At 100 °C.")
    density_15: OilDensity | None = option("At 15 °C.")


_SHORT_KEYS = dict.fromkeys(("iso_vg", "viscosity_40", "viscosity_100"), "kinematic_viscosity")
_SHORT_KEYS["density_15"] = "density"


def _refused_oil(what: str, remedy: str) -> PydanticCustomError:
    return PydanticCustomError("oil", "{what}", {"what": what, "remedy": remedy})


def whole_oil(table: dict[str, Any], preset: Mapping[str, Any] | None) -> dict[str, Any]:
    """The properties of an oil that its grade or two viscosities describe; others as they are.

    `preset` has those of a built-in oil of this grade and kind, if there is one. Raises
    `PydanticCustomError` if the table does not tell the viscosity at two temperatures.
    """
    if not _SHORT_KEYS.keys() & table.keys():
        return table
    grade = table.get("iso_vg")
    own = {key: value for key, value in table.items() if key not in _SHORT_KEYS}
    if grade is not None and grade not in GRADES:
        near = ", ".join(map(str, GRADES))
        raise _refused_oil(
            f"has no viscosity grade of ISO 3448: iso_vg must be one of {near}", "Choose one"
        )
    pairs = [("iso_vg", "viscosity_40"), *_SHORT_KEYS.items()]
    twice = ", ".join(" and ".join(pair) for pair in pairs if {*pair} <= table.keys())
    if twice:
        raise _refused_oil(f"states the same twice: {twice}", "Keep one key of each pair")
    if preset is not None and "viscosity_100" not in table:
        whole = dict(preset) | own
    else:
        whole = _typical(str(table.get("kind"))) | own
        if "kinematic_viscosity" not in own:
            whole["kinematic_viscosity"] = _viscosities(table)
    if "density_15" in table:
        whole["density"] = (_point("15 degC", table["density_15"], "as stated"),)
    return whole


def _viscosities(table: Mapping[str, Any]) -> tuple[dict[str, Any], ...]:
    grade, warm = table.get("iso_vg"), table.get("viscosity_100")
    if warm is None and grade is not None and str(table.get("kind")) not in GOLD:
        warm = "1 mm^2/s"  # never used: the missing or wrong kind is refused
    elif warm is None:
        raise _refused_oil(
            "leaves the viscosity at 100 °C open, and no built-in oil has this grade and kind",
            'Add viscosity_100 = "... mm^2/s" from the data sheet',
        )
    if grade is None and "viscosity_40" not in table:
        raise _refused_oil("leaves the viscosity at 40 °C open", "Add iso_vg or viscosity_40")
    stated = table.get("viscosity_40", f"{_SMALL.get(grade or 0, grade)} mm^2/s")
    source = "as stated" if grade is None else "ISO 3448, middle of the grade"
    return _point("40 degC", stated, source), _point("100 degC", warm, "as stated")


def _point(temperature: str, value: Any, source: str) -> dict[str, Any]:
    return {"temperature": temperature, "value": value, "source": source}


def _typical(kind: str) -> dict[str, Any]:
    """What a kind of oil has if nothing else is known; of an unknown kind that of mineral oil."""
    s, t, base = GOLD.get(kind, GOLD["mineral"])
    density = f"{DENSITY.get(kind, DENSITY['mineral'])} kg/m^3"
    return {
        "density": (_point("15 degC", density, f"typical of {base}, an estimate"),),
        "pressure_viscosity": {
            "law": "gold",
            "s": s,
            "t": t,
            "source": f"Gold et al. 2001, {base}, second hand; not measured on this oil",
        },
    }


def short_oil_told(table: object, preset: str | None) -> tuple[str, str] | None:
    """What a short table of an oil stands for, and where that comes from; None of others.

    `preset` is the name of the built-in oil of this grade and kind.
    """
    if not isinstance(table, Mapping) or not _SHORT_KEYS.keys() & table.keys():
        return None
    if preset is not None and "viscosity_100" not in table:
        return preset, "the built-in oil of this grade and kind ('epicyclic oils' shows it)."
    told = []
    if "density" not in table and "density_15" not in table:
        told.append(f"density {DENSITY[table['kind']]} kg/m^3 at 15 °C, an estimate")
    if "pressure_viscosity" not in table:
        told.append(
            "pressure-viscosity coefficient from Gold's constants for "
            f"{GOLD[table['kind']][2]}, not measured on this oil"
        )
    return f"an oil of the kind {table['kind']}", f"{'; '.join(told) or 'all stated'}."
