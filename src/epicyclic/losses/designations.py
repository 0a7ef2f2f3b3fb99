"""Rolling bearings by designation: boundary dimensions, rolling elements, load ratings."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from typing import Any

import numpy as np

from epicyclic.dataclass import dataclass, replace
from epicyclic.errors import Problem
from epicyclic.library import bearing_tables
from epicyclic.messages import did_you_mean, millimetres

RATING_BAND = 0.3
"""Relative deviation of estimated load ratings from catalogues, of the tests' sample. [1]"""
_BORES = {"00": 10, "01": 12, "02": 15, "03": 17, "/22": 22, "/28": 28, "/32": 32}
"""Codes of bores in mm; further ones are bore/5."""
_ANGLES = {"AC": 25.0, "A": 30.0, "B": 40.0, "C": 15.0, "E": 25.0}
"""Contact angle by the letter after the size of an angular contact ball bearing. [deg]"""
_WITHOUT_RIB = re.compile(r"(NUP|NJ|N)(?=\d)")  # the other cylindrical types have the sizes of NU
SEALED = re.compile(r"\d.*(RS|LLU|DDU)", re.IGNORECASE)
_BY_SIZE = re.compile(r"(?P<kind>NKI)(?P<bore>\d+)/(?P<width>\d+)")
_CAGE = re.compile(r"K(?P<bore>\d+)X(?P<outside>\d+)X(?P<width>\d+)")

# Diameter of the rolling elements over D - d, share of the pitch circle that they fill, length over
# the width of all rows; estimates after a few bearings whose rollers are known. Balls of deep
# groove bearings fill an arc, over which the rings can be assembled.
ELEMENTS: Mapping[str, tuple[float, float, float]] = {
    "deep-groove": (0.3, math.nan, 0.0),
    "angular-contact": (0.3, 0.9, 0.0),
    "cylindrical": (0.275, 0.83, 0.65),
    "tapered": (0.26, 0.87, 0.7),
    "spherical": (0.25, 0.85, 0.76),
    "needle": (0.17, 0.8, 0.7),
}
ASSEMBLY_ARC = math.radians(195)
SPHERICAL_ANGLE = math.radians(10)
"""Usual contact angle of spherical roller bearings."""
_FILL_FULL_COMPLEMENT = 0.98


@dataclass(frozen=True, slots=True)
class DesignatedBearing:
    """What a designation fixes of a bearing, and the rolling elements that fit in."""

    designation: str
    type: str  # "deep-groove", "angular-contact", "cylindrical", "tapered", ...
    bore: float  # [m]
    outside_diameter: float  # [m]
    width: float  # Of tapered bearings that of the inner ring. [m]
    contact_angle: float = 0.0  # [rad]
    cage: str = "caged"
    rows: int = 1
    series: str = ""  # In SKF's friction model; empty if it has none.
    pitch_diameter: float = math.nan  # [m]
    element_diameter: float = math.nan  # D_w, of balls or rollers. [m]
    element_length: float = 0.0  # L_we of one roller; 0 for balls. [m]
    elements: int = 0  # In one row.

    @property
    def dynamic_load_rating(self) -> float:
        """C of ISO 281, from the elements. Theory (J27). [N]"""
        D_w, cosine = 1e3 * self.element_diameter, math.cos(self.contact_angle)
        gamma = self.element_diameter * cosine / self.pitch_diameter
        if not self.element_length:
            factor = 1.3 * ball_factor(gamma)
            size = D_w**1.8 if D_w <= 25.4 else 3.647 * D_w**1.4
            return float(factor * (self.rows * cosine) ** 0.7 * self.elements ** (2 / 3) * size)
        length = (1e3 * self.rows * self.element_length * cosine) ** (7 / 9)
        factor = 1.1 * roller_factor(gamma) * self.elements**0.75
        return float(factor * length * D_w ** (29 / 27))

    @property
    def static_load_rating(self) -> float:
        """C0 of ISO 76, from the elements. Theory (J28). [N]"""
        D_w, cosine = 1e3 * self.element_diameter, math.cos(self.contact_angle)
        gamma = self.element_diameter * cosine / self.pitch_diameter
        count = self.rows * self.elements
        if not self.element_length:
            return static_ball_factor(gamma) * count * D_w**2 * cosine
        return 44 * (1 - gamma) * count * 1e3 * self.element_length * D_w * cosine


def ball_factor(gamma: float) -> float:
    """f_c of ISO 281 for balls, osculation 0.52, D_w cos(alpha)/d_m = gamma. Theory (J27). [1]"""
    rings = 1.04 * ((1 - gamma) / (1 + gamma)) ** 1.72
    shape = gamma**0.3 * (1 - gamma) ** 1.39 / (1 + gamma) ** (1 / 3)
    return float(0.95 * 39.9 * (1 + rings ** (10 / 3)) ** -0.3 * shape * 26**0.41)


def roller_factor(gamma: float) -> float:
    """f_c of ISO 281 for rollers. Theory (J27). [1]"""
    rings = 1.04 * ((1 - gamma) / (1 + gamma)) ** (143 / 108)
    shape = gamma ** (2 / 9) * (1 - gamma) ** (29 / 27) / (1 + gamma) ** 0.25
    return float(0.83 * 207.9 * (1 + rings**4.5) ** (-2 / 9) * shape)


def static_ball_factor(gamma: float) -> float:
    """f_0 of ISO 76 for balls, straight between a few values of its table. Theory (J28). [1]"""
    return float(np.interp(gamma, (0.0, 0.09, 0.2, 0.3, 0.4), (14.7, 16.5, 14.0, 11.6, 9.4)))


def designated(text: str) -> DesignatedBearing:
    """The bearing of a designation; letters after the size only tell the angle of balls.

    Raises `KeyError`, whose argument is a hint, if the plans have no such bearing.

    Examples
    --------
    >>> found = designated("NU 2210 ECP")
    >>> round(1e3 * found.bore), round(1e3 * found.outside_diameter), round(1e3 * found.width)
    (50, 90, 23)
    """
    name = re.sub(r"[\s\-]2(?=RS|Z)|[\s.\-]", "", text.upper())  # 2RS and 2Z are seals and shields
    by_size, cage = _BY_SIZE.match(name), _CAGE.match(name)
    if by_size:
        bores = bearing_tables("dimensions")["needle"][by_size["kind"]]
        if by_size["bore"] not in bores:
            raise KeyError(f"{by_size['kind']} has the bores {', '.join(bores)}")
        bore, width = int(by_size["bore"]), int(by_size["width"])
        outside = bores[by_size["bore"]]
        return with_elements(DesignatedBearing(text, "needle", bore, outside, width))
    if cage and int(cage["bore"]) < int(cage["outside"]):
        bore, outside, width = (int(cage[key]) for key in ("bore", "outside", "width"))
        found = DesignatedBearing(text, "needle", bore, outside, width)
        return with_elements(found, diameter=(outside - bore) / 2)
    name = _WITHOUT_RIB.sub("NU", name)
    known = _known()
    sizes = [
        size for size in known if name.startswith(size) and not name[len(size) :][:1].isdigit()
    ]
    if not sizes:
        raise KeyError(did_you_mean(text.upper(), [one.designation for one in known.values()]))
    size = max(sizes, key=len)
    bearing = replace(known[size], designation=text)
    if bearing.type == "angular-contact":
        rest = name[len(size) :]
        letters = next((letters for letters in _ANGLES if rest.startswith(letters)), "B")
        bearing = replace(bearing, contact_angle=math.radians(_ANGLES[letters]))
    return with_elements(bearing)


@cache
def _known() -> Mapping[str, DesignatedBearing]:
    """Every designation made of series and bore, without spaces."""
    return {one.designation.replace(" ", ""): one for one in _listed()}


def _listed() -> Iterator[DesignatedBearing]:
    tables = bearing_tables("dimensions")
    angles = tables["tapered"]
    for kind in tables["kinds"]:
        for number, prefix in enumerate(kind["names"]):
            plan = tables["series"][kind["series"][number]]
            choice = kind["width"][number]
            widths = plan["tapered"] if choice == "tapered" else plan["width"][choice]
            tapered, angle = kind["type"] == "tapered", {}
            if tapered:
                angle = dict(zip(angles["bore"], angles[kind["angle"][number]], strict=True))
            smallest = kind["smallest"][number] if "smallest" in kind else 0
            for bore, outside, width in zip(plan["bore"], plan["outside"], widths, strict=True):
                if not width or bore < smallest or (tapered and not angle.get(bore)):
                    continue
                own = SPHERICAL_ANGLE if kind["type"] == "spherical" else 0.0
                yield DesignatedBearing(
                    f"{prefix}{_code(bore)}",
                    kind["type"],
                    bore,
                    outside,
                    width,
                    contact_angle=math.radians(angle[bore]) if angle else own,
                    cage=kind.get("cage", "caged"),
                    rows=kind["rows"][number] if "rows" in kind else 1,
                    series=kind["skf"][number] if "skf" in kind else "",
                )
    for number, plan in tables["thrust"].items():  # cylindrical rollers have the sizes of balls
        for series, kind in ((number, "thrust-ball"), (f"8{number[1:]}", "thrust-roller")):
            for size in zip(plan["bore"], plan["outside"], plan["height"], strict=True):
                yield DesignatedBearing(f"{series}{_code(size[0])}", kind, *size)


def _code(bore: int) -> str:
    return next((code for code, size in _BORES.items() if size == bore), f"{bore // 5:02d}")


def with_elements(bearing: DesignatedBearing, diameter: float | None = None) -> DesignatedBearing:
    """A bearing of sizes in millimetres with the rolling elements that fit, and in metres.

    The elements of thrust bearings are left open, and so are their load ratings.
    """
    share, fill, length = ELEMENTS.get(bearing.type, (math.nan, 0.0, math.nan))
    pitch = (bearing.bore + bearing.outside_diameter) / 2
    if diameter is None:
        diameter = share * (bearing.outside_diameter - bearing.bore)
    half = math.asin(diameter / pitch)  # the angle that half an element takes
    if bearing.cage == "full-complement":
        fill = _FILL_FULL_COMPLEMENT
    count = 1 + ASSEMBLY_ARC / (2 * half) if math.isnan(fill) else fill * math.pi / half
    return replace(
        bearing,
        bore=bearing.bore / 1e3,
        outside_diameter=bearing.outside_diameter / 1e3,
        width=bearing.width / 1e3,
        pitch_diameter=pitch / 1e3,
        element_diameter=diameter / 1e3,
        element_length=length * bearing.width / bearing.rows / 1e3,
        elements=int(np.nan_to_num(count)),
    )


def designated_or_any(text: object, other: str = "6208") -> DesignatedBearing:
    """The bearing of a designation; another if there is none, whose key has that problem."""
    try:
        return designated(str(text))  # that of digits alone may be a number
    except KeyError:
        return designated(other)


# What a case takes of a designation: strings and numbers as a file has them.

THRUST_FACTORS = {"thrust-ball": 1.5, "thrust-roller": 3.5}
"""f0 in an oil bath, Harris (1991); general knowledge. [1]"""
PLANET_BEARINGS = ("needle", "cylindrical", "spherical")


def _shaft_keys(raw: Mapping[str, Any]) -> dict[str, Any]:
    found = designated_or_any(raw["designation"])
    sizes = {"bore": found.bore, "outside_diameter": found.outside_diameter, "width": found.width}
    keys: dict[str, Any] = {key: f"{1e3 * size:g} mm" for key, size in sizes.items()}
    keys |= {"type": found.type, "cage": found.cage}
    keys |= {"series": found.series} if found.series and raw.get("model") == "skf-2018" else {}
    stated = found.type == "spherical" or {"axial_factor", "contact_angle"} & raw.keys()
    if found.contact_angle and not stated:
        keys["contact_angle"] = f"{math.degrees(found.contact_angle):.4g} deg"
    return keys


def _planet_keys(raw: Mapping[str, Any]) -> dict[str, Any]:
    found = designated_or_any(raw["designation"], "NU 2210")
    if found.type not in PLANET_BEARINGS:  # its key has that problem
        found = designated_or_any("NU 2210")
    # middle of the normal group of ISO 5753-1 for cylindrical rollers, by a straight line [m]
    clearance = 20e-6 + 0.55e-3 * found.bore
    inner = found.pitch_diameter - found.element_diameter - clearance / 2
    sizes = {"roller_diameter": found.element_diameter, "roller_length": found.element_length}
    sizes |= {"pin_diameter": inner, "diametral_clearance": clearance}
    keys: dict[str, Any] = {key: f"{1e3 * size:.6g} mm" for key, size in sizes.items()}
    keys |= {"rows": found.rows, "rollers_per_row": found.elements, "cage": found.cage}
    keys |= {"roller_roughness": "0.1 um", "race_roughness": "0.15 um"}
    return keys | {"type": found.type}


def _thrust_keys(raw: Mapping[str, Any]) -> dict[str, Any]:
    found = designated_or_any(raw["designation"], "51108")
    diameter = f"{1e3 * (found.bore + found.outside_diameter) / 2:g} mm"
    return {"mean_diameter": diameter, "viscous_factor": THRUST_FACTORS.get(found.type, 1.5)}


def _checked(text: str) -> DesignatedBearing:
    try:
        return designated(text)
    except KeyError as error:
        reason = "is not known; it must be a size of the ISO plans, such as "
        reason += '"6208", "NU 2210", "32006", "NKI 40/30", "22210", "51107"'
        raise KeyError(reason, error.args[0] or "Give the dimensions instead") from None


def _checked_planet(text: str) -> None:
    kind = _checked(text).type
    if kind not in PLANET_BEARINGS:
        reason = f"is a {kind} bearing; planets have needle, cylindrical or spherical rollers, or "
        remedy = 'Choose one such as "NU 2210", "22220", "NKI 40/30" or "K 40x48x20"'
        raise KeyError(f"{reason}a [planet_pin]", remedy)


def _checked_thrust(text: str) -> None:
    name = re.sub(r"[\s.\-]", "", text.upper())
    known = [name for name, one in _known().items() if one.type.startswith("thrust")]
    if name not in known:
        reason = 'is not known; it must be a size of ISO 104, such as "51108"'
        raise KeyError(reason, did_you_mean(name, known) or "Give mean_diameter instead")


CHECKS: Mapping[str, Callable[[str], object]] = {
    "shaft": _checked,
    "planet": _checked_planet,
    "thrust": _checked_thrust,
}
"""Raise `KeyError` with a reason and a remedy for designations of no such bearing."""
KEYS: Mapping[str, Callable[[Mapping[str, Any]], dict[str, Any]]] = {
    "shaft": _shaft_keys,
    "planet": _planet_keys,
    "thrust": _thrust_keys,
}
"""The keys that a designation gives."""
_SIZES: Mapping[str, Mapping[str, float]] = {
    "shaft": {"bore": 0.01, "outside_diameter": 0.01, "width": 0.15},  # rings differ in width
    "planet": {"pin_diameter": 0.25, "roller_diameter": 0.25},  # estimates here
    "thrust": {"mean_diameter": 0.01},
}
"""By how much sizes of each kind of table may differ from those of its designation. [1]"""


def unlike(kind: str, table: Any, at: str = "") -> Iterator[Problem]:
    """Sizes of the table at a key that are not those of its designation."""
    if not table.designation:
        return
    planned = KEYS[kind]({"designation": table.designation})
    if (own := planned.get("type", "")) != getattr(table, "type", own):
        reason = f"is that of a {own} bearing, and type is {table.type}."
        yield Problem(f"{at}designation", table.designation, reason, "Delete one of them.")
        return
    for key, share in _SIZES[kind].items():
        size, usual = getattr(table, key), float(planned[key].removesuffix(" mm")) / 1e3
        if size is not None and abs(size - usual) > share * usual:
            about = "" if share == 0.01 else "about "
            reason = f"is {about}{millimetres(usual)} for {table.designation}."
            yield Problem(at + key, millimetres(size), reason, "Delete one of them.")
