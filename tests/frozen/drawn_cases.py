"""Random planetary sets and gear pairs, drawn from a seed.

Every option of a case appears in them; within each case no two numbers are equal, so that a value
that reaches the wrong place changes the result.
"""

from __future__ import annotations

import math
import random
from collections.abc import Iterable, Iterator
from typing import Any

import epicyclic as ep
from epicyclic import library

SEED = 20121
PLANETARY, PAIRS = 190, 110
ATTEMPTS = 3000

Tables = dict[str, Any]
Options = dict[str, Any]

MEMBERS = ("sun", "ring", "carrier")
DRIVES = [
    (one, two, alone) for one in MEMBERS for two in MEMBERS if one != two for alone in (True, False)
]
FRICTION = (
    "auto", "mixed-ehl", "schlenk", "niemann-winter", "benedict-kelley", "matsumoto", "doleschel",
    "xu-2007", "constant", "table",
)  # fmt: skip
CLOSURES = ("isentropic", "mean-density", "incompressible", "central-differences")
COMMON: dict[str, tuple[Any, ...]] = {
    "friction": FRICTION,
    "rolling": ("auto", "mixed-ehl", "goksem-hargreaves", None),
    "distribution": ("uniform", "minimum-energy", "compliance", "compliance", None),
    "mesh": ("local", "local", None, "loss-factor"),
    "oil": (*library.names("oils"), *["table"] * 10),
    "pocketing": (None, None, *CLOSURES, None, None, None, None, None, None),
    "torque": (1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 0),
    "speed": (1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 0),
    "spur": (True, False, False, False),
    "transverse": (True, False, False),
    "thickness": (True, False),
    "materials": ("tables", "tables", "names", None),
    "finishes": (True, False, False, False),
    "micro_geometry": (True, False),
    "topography": (True, False, False, False, False),
    "misalignment": (True, False),
    "details": (True, False),
    "surroundings": ("both", "ratio", None),
    "left_out": (True, False, False),
    "factor": (True, False, False),
}
"""Choices, each drawn as often as it is written here."""
OF_PLANETARY: dict[str, tuple[Any, ...]] = {
    "drive": tuple(DRIVES),
    "count": (1, 2, 3, 3, 4, 4, 5, 6),
    "bearing_table": (True, True, True, False),
    "bearing": ("auto", "palmgren", "mixed-ehl", None),
    "cage": ("caged", "full-complement", None),
    "tilt": ("coupled", "left-out", None, None, None),
    "sharing": ("equal", "mesh-load-factor", "closed-form", "direct", None),
    "floating": (*MEMBERS, "none", None),
    "thrust": (
        "sun-carrier", "sun-ring", "ring-carrier", "sun-housing", "carrier-housing", None, None,
    ),
    "carrier": (True, True, False),
    "mass": (True, False),
    "angles": (True, False, False),
    "ring_side": (True, False),
}  # fmt: skip
OF_PAIRS: dict[str, tuple[Any, ...]] = {"internal": (True, False, False)}
PLANETARY_LOSSES = (
    "sun_mesh_sliding", "sun_mesh_rolling", "ring_mesh_sliding", "ring_mesh_rolling",
    "planet_bearing_mechanical", "planet_bearing_viscous", "sun_drag", "ring_drag", "carrier_drag",
    "thrust_bearing_viscous",
)  # fmt: skip
PAIR_LOSSES = ("mesh_sliding", "mesh_rolling", "drag")


class Decks:
    """Options drawn like cards: each comes once before any comes again."""

    def __init__(self, choices: dict[str, tuple[Any, ...]], rng: random.Random) -> None:
        self._choices, self._rng = choices, rng
        self._left: dict[str, list[Any]] = {name: [] for name in choices}

    def draw(self) -> Options:
        """One option of each kind."""
        drawn = {}
        for name, options in self._choices.items():
            if not self._left[name]:
                self._left[name] = self._rng.sample(options, len(options))
            drawn[name] = self._left[name].pop()
        return drawn


class Numbers:
    """Random numbers for one case, no two of them equal."""

    def __init__(self, rng: random.Random) -> None:
        self.rng = rng
        self._used: set[float | str] = set()

    def number(self, low: float, high: float, digits: int = 4) -> float:
        """Evenly distributed."""
        while True:
            value = float(f"{self.rng.uniform(low, high):.{digits}g}")
            if abs(value) not in self._used:
                self._used.add(abs(value))
                return value

    def spread(self, low: float, high: float, digits: int = 4) -> float:
        """With evenly distributed logarithm."""
        while True:
            value = float(f"{math.exp(self.rng.uniform(math.log(low), math.log(high))):.{digits}g}")
            if value not in self._used:
                self._used.add(value)
                return value

    def whole(self, low: int, high: int) -> int:
        """A whole number; one that is there already only if all are."""
        fresh = [value for value in range(low, high + 1) if value not in self._used]
        value = self.rng.choice(fresh or range(low, high + 1))
        self._used.add(value)
        return value

    def name(self, known: Iterable[str]) -> str:
        """A name that is not there yet."""
        name = self.rng.choice([name for name in sorted(known) if name not in self._used])
        self._used.add(name)
        return name

    def text(self, low: float, high: float, unit: str, digits: int = 4) -> str:
        """With a unit."""
        return f"{self.number(low, high, digits)!r} {unit}"


# --- gears ----------------------------------------------------------------------------------------


def draw_rack(numbers: Numbers, options: Options) -> Tables:
    """The table of what all gears share, without the centre distance."""
    angle = numbers.text(19, 24, "deg")
    tables: Tables = {
        "helix_angle": "0 deg" if options["spur"] else numbers.text(6, 28, "deg"),
        "addendum_coefficient": numbers.number(0.82, 1.0),
        "dedendum_coefficient": numbers.number(1.2, 1.35),
    }
    kind = "transverse" if options["transverse"] else "normal"
    return {
        f"{kind}_module": f"{numbers.spread(0.9, 6.0)!r} mm",
        f"{kind}_pressure_angle": angle,
        **tables,
    }


def value(text: str) -> float:
    """The number of a text with a unit."""
    return float(text.split()[0])


class Rack:
    """What the shared table says, as numbers in mm and rad."""

    def __init__(self, gears: Tables) -> None:
        cosine = math.cos(math.radians(value(gears["helix_angle"])))
        if "transverse_module" in gears:
            self.module = value(gears["transverse_module"])
            self.angle = math.radians(value(gears["transverse_pressure_angle"]))
        else:
            self.module = value(gears["normal_module"]) / cosine
            normal = math.radians(value(gears["normal_pressure_angle"]))
            self.angle = math.atan(math.tan(normal) / cosine)
        self.normal_module = self.module * cosine

    def shifts(self, teeth: int, distance: float) -> float:
        """Sum of the profile shifts without backlash; `teeth`: sum, or difference if internal."""
        working = math.acos(teeth * self.module / 2 * math.cos(self.angle) / distance)
        involutes = math.tan(working) - working - math.tan(self.angle) + self.angle
        per_shift = 2 * math.tan(self.angle) * self.normal_module / self.module
        return teeth * involutes / per_shift


def draw_gear(
    numbers: Numbers, options: Options, rack: Rack, teeth: int, shift: float, width: float
) -> Tables:
    """The table of a gear."""
    module = rack.normal_module
    tables: Tables = {
        "teeth": teeth,
        "face_width": f"{width!r} mm",
        "roughness": f"{numbers.spread(0.06, 1.6)!r} um",
    }
    if options["thickness"]:
        arc = math.pi * rack.module / 2 + 2 * shift * module * math.tan(rack.angle)
        tables["tooth_thickness"] = f"{arc:.5g} mm"
        tables["thickness_diameter"] = f"{teeth * rack.module:.7g} mm"
    else:
        tables["profile_shift_coefficient"] = round(shift, 5)
    if options["finishes"]:
        tables["roughness"] = numbers.name(library.named("finishes"))
    if options["materials"] == "tables":
        tables["material"] = draw_material(numbers)
    elif options["materials"] == "names":
        tables["material"] = numbers.name(library.named("materials"))
    if options["details"]:
        tables["tip_chamfer"] = numbers.text(0.01 * module, 0.06 * module, "mm")
        tables["tool_tip_radius"] = numbers.text(0.05 * module, 0.22 * module, "mm")
    return tables


def draw_material(numbers: Numbers) -> Tables:
    return {
        "elastic_modulus": numbers.text(105, 215, "GPa"),
        "poisson_ratio": numbers.number(0.26, 0.34),
        "density": numbers.text(7100, 8600, "kg/m^3"),
    }


def draw_micro_geometry(numbers: Numbers, module: float, width: float) -> Tables:
    """Some of the modifications of a flank."""
    shapes, um = ("linear", "parabolic"), "um"
    groups = {
        "tip": {
            "tip_relief": numbers.text(2, 9, um),
            "tip_relief_roll_length": numbers.text(0.6 * module, 1.3 * module, "mm"),
            "tip_relief_shape": numbers.rng.choice(shapes),
        },
        "root": {
            "root_relief": numbers.text(2, 7, um),
            "root_relief_roll_length": numbers.text(0.5 * module, 1.0 * module, "mm"),
            "root_relief_shape": numbers.rng.choice(shapes),
        },
        "profile": {
            "profile_crown": numbers.text(0.5, 3, um),
            "profile_slope": numbers.text(-3, 3, um),
        },
        "lead": {"lead_crown": numbers.text(0.5, 4, um), "lead_slope": numbers.text(-4, 4, um)},
        "end": {
            "end_relief": numbers.text(1, 8, um),
            "end_relief_length": numbers.text(0.05 * width, 0.2 * width, "mm"),
            "end_relief_shape": numbers.rng.choice(shapes),
        },
    }
    chosen = numbers.rng.sample(sorted(groups), numbers.rng.randint(2, 5))
    return {key: item for name in chosen for key, item in groups[name].items()}


def draw_topography(numbers: Numbers, rack: Rack, teeth: int, shift: float, width: float) -> Tables:
    """Deviations measured over an external flank."""
    middle = teeth * rack.module + 2 * shift * rack.normal_module
    reach = rack.normal_module
    places = [
        [f"{middle + part * reach:.6g} mm" for part in (-1.1, 0.1, 1.6)],
        [f"{part * width:.5g} mm" for part in (0.02, 0.3, 0.97)],
    ]
    deviations = [[numbers.text(-2, 4, "um") for _ in range(3)] for _ in range(3)]
    return {"diameter": places[0], "face_position": places[1], "deviation": deviations}


# --- what both kinds of cases have ----------------------------------------------------------------


def draw_oil(numbers: Numbers) -> Tables:
    """A table of an oil's properties."""
    cold = numbers.spread(15, 500)
    warm = numbers.number(0.1, 0.17) * cold**0.82
    tables: Tables = {
        "name": "drawn oil",
        "kind": numbers.rng.choice(["mineral", "pao", "ester", "pag", "atf"]),
        "kinematic_viscosity": [
            {"temperature": "40 degC", "value": f"{cold!r} mm^2/s"},
            {"temperature": "100 degC", "value": f"{warm + 1.5:.4g} mm^2/s"},
        ],
        "density": [{"temperature": "15 degC", "value": numbers.text(820, 1000, "kg/m^3")}],
        "density_slope": {"value": -numbers.number(0.5, 0.85)},
        "lubricant_factor": {"value": numbers.number(0.6, 1.1)},
        "pressure_viscosity": {
            "law": "gold",
            "s": numbers.number(5, 10),
            "t": numbers.number(0.11, 0.16),
        },
    }
    if numbers.rng.random() < 0.4:
        tables["pressure_viscosity"] = {
            "law": "roelands",
            "point": [
                {"temperature": "40 degC", "value": numbers.text(15, 22, "1/GPa")},
                {"temperature": "90 degC", "value": numbers.text(10, 14, "1/GPa")},
            ],
        }
    return tables


def draw_friction_table(numbers: Numbers) -> Tables:
    """Coefficients of friction over one or two quantities."""
    axes: Tables = {
        "slide_to_roll_ratio": [0.0, numbers.number(0.05, 0.2), numbers.number(0.4, 0.9)],
        "film_ratio": [numbers.number(0.05, 0.3), numbers.number(0.8, 1.4), numbers.number(2, 4)],
        "hertz_pressure": [numbers.text(0.2, 0.5, "GPa"), numbers.text(1.1, 1.8, "GPa")],
        "rolling_speed": [numbers.text(0.1, 0.9, "m/s"), numbers.text(8.1, 15, "m/s")],
    }
    names = numbers.rng.sample(list(axes), numbers.rng.randint(1, 2))
    names.sort(key=list(axes).index)
    shape = [len(axes[name]) for name in names]
    rows = [
        [numbers.number(0.012, 0.11) for _ in range(shape[-1])]
        for _ in range(shape[0] if len(shape) == 2 else 1)
    ]
    return {name: axes[name] for name in names} | {"friction": rows if len(shape) == 2 else rows[0]}


def draw_models(numbers: Numbers, options: Options, keys: dict[str, str]) -> Tables:
    """Which models are used: `keys` to the options that choose them."""
    tables: Tables = {key: options[name] for key, name in keys.items() if options[name] is not None}
    if options["friction"] == "constant":
        tables["constant_friction"] = numbers.number(0.02, 0.09)
    if options["friction"] in ("matsumoto", "doleschel"):
        tables["boundary_friction"] = numbers.number(0.08, 0.14)
        tables["fluid_friction"] = numbers.number(0.015, 0.035)
    if options["pocketing"] is not None:
        tables["pocket_end_length"] = numbers.number(0.5, 1.5)
    return tables


def draw_numerics(numbers: Numbers, options: Options) -> Tables:
    """A coarse resolution."""
    rng = numbers.rng
    elastic = options["distribution"] in ("compliance", None)
    tables = {
        "mesh_positions": rng.randint(4, 6 if elastic else 12),
        "contact_segments": rng.randint(4, 7 if elastic else 14),
    }
    if options["pocketing"] is not None:
        tables |= {"pocket_slices": rng.randint(5, 7), "pocket_steps": rng.randint(9, 12)}
    if "count" in options:
        tables["bearing_slices"] = rng.randint(3, 9)
    return tables


def draw_losses(
    numbers: Numbers, options: Options, names: tuple[str, ...], pockets: tuple[str, ...]
) -> Tables:
    """What becomes of the loss terms."""
    rng = numbers.rng
    tables: Tables = {}
    if options["pocketing"] is None:
        tables |= {name: {"include": False} for name in pockets}
    if options["left_out"]:
        tables[rng.choice(names)] = {"include": False}
    if options["factor"]:
        tables[rng.choice([*names, *pockets])] = {"factor": numbers.number(0.4, 2.5)}
    return tables


def draw_common(numbers: Numbers, options: Options) -> Tables:
    """Oil, its temperature, and what surrounds the gears."""
    oil = draw_oil(numbers) if options["oil"] == "table" else options["oil"]
    tables: Tables = {"lubricant": {"oil": oil}}
    if numbers.rng.random() < 0.3:
        tables["lubricant"]["pressure_viscosity_factor"] = numbers.number(0.7, 1.4)
    if options["surroundings"] is not None:
        tables["surroundings"] = {"oil_air_ratio": numbers.number(0.005, 0.4)}
    if options["surroundings"] == "both":
        tables["surroundings"]["pressure"] = numbers.text(0.75, 1.8, "bar")
    if options["friction"] == "table":
        tables["friction_table"] = draw_friction_table(numbers)
    return tables


def signed(text: str, sign: int) -> str:
    """`text` with another sign, or as zero."""
    number, unit = text.split()
    return f"{sign * float(number)!r} {unit}" if sign else f"0 {unit}"


# --- planetary sets -------------------------------------------------------------------------------


def draw_planetary(title: str, options: Options, rng: random.Random) -> Tables:
    """The tables of a planetary set, which may or may not be possible."""
    numbers = Numbers(rng)
    count = options["count"]
    numbers.whole(count, count)
    gears = draw_rack(numbers, options)
    rack = Rack(gears)
    sun, planet = numbers.whole(18, 75), numbers.whole(17, 42)
    ring = sun + 2 * planet + rng.choice([-1, 0, 0, 1])
    if options["sharing"] == "closed-form":
        ring += -(sun + ring) % count
    module = rack.normal_module
    reference = (2 * sun + 2 * ring) * rack.module / 8  # mean of both meshes
    distance = float(f"{reference + rng.uniform(-0.15, 0.35) * module:.6g}")
    gears["center_distance"] = f"{distance!r} mm"
    own = rng.uniform(-0.1, 0.4)
    shifts = {
        "sun": rack.shifts(sun + planet, distance) - own - rng.uniform(0.005, 0.06),
        "planet": own,
        "ring": -rack.shifts(ring - planet, distance) - own - rng.uniform(0.005, 0.06),
    }
    width = numbers.spread(5 * module, 16 * module)
    widths = {name: float(f"{numbers.number(0.9, 1.15) * width:.4g}") for name in shifts}
    tables: Tables = {"kind": "planetary", "title": title, "operation": {}, "gears": gears}
    for name, teeth in (("sun", sun), ("planet", planet), ("ring", ring)):
        tables[name] = draw_gear(numbers, options, rack, teeth, shifts[name], widths[name])
        if options["micro_geometry"]:
            table = draw_micro_geometry(numbers, module, widths[name])
            tables[name]["micro_geometry"] = table
    tables["planet"]["count"] = count
    if options["micro_geometry"] and options["ring_side"]:
        table = draw_micro_geometry(numbers, module, widths["planet"])
        tables["planet"]["micro_geometry_ring_side"] = table
    if options["micro_geometry"] and options["topography"]:
        table = draw_topography(numbers, rack, sun, shifts["sun"], widths["sun"])
        tables["sun"]["micro_geometry"]["topography"] = table
    if options["mass"]:
        tables["planet"]["mass"] = f"{numbers.spread(0.05, 2.0)!r} kg"
    if options["angles"] and options["sharing"] != "closed-form":
        tables["planet"]["angles"] = draw_angles(rng, count, sun + ring)
    if options["details"]:
        tables["ring"]["rim_thickness"] = numbers.text(2 * module, 6 * module, "mm")
    if options["misalignment"]:
        for mesh in ("sun_mesh", "ring_mesh"):
            tables[mesh] = {"misalignment": numbers.text(-7, 7, "um")}
    force = numbers.spread(3, 110) * module * width  # N, for each planet
    torque = count * force * sun * rack.module / 2000
    speed = min(18000.0, numbers.spread(0.5, 25) * 60000 / (math.pi * sun * rack.module))
    draw_drive(tables["operation"], numbers, options, torque, speed, ring / sun)
    draw_parts(tables, numbers, options, rack)
    tables["load_sharing"] = draw_sharing(numbers, options)
    tables |= draw_common(numbers, options)
    keys = {
        "friction": "friction", "rolling": "rolling", "load_distribution": "distribution",
        "mesh": "mesh", "pocketing": "pocketing", "bearing": "bearing", "planet_tilt": "tilt",
    }  # fmt: skip
    tables["models"] = draw_models(numbers, options, keys)
    tables["numerics"] = draw_numerics(numbers, options)
    pockets = ("sun_mesh_pocketing", "ring_mesh_pocketing")
    tables["losses"] = draw_losses(numbers, options, PLANETARY_LOSSES, pockets)
    return {key: table for key, table in tables.items() if table != {}}


def draw_angles(rng: random.Random, count: int, places: int) -> list[str]:
    """Positions at which planets can be assembled."""
    chosen = {round(place * places / count + rng.uniform(-2, 2)) % places for place in range(count)}
    return [f"{360 * place / places:.5f} deg" for place in sorted(chosen)]


def draw_drive(
    operation: Tables, numbers: Numbers, options: Options, torque: float, speed: float, ratio: float
) -> None:
    """The operating point: torque and speed of the sun turned into those of the input."""
    driver, other, alone = options["drive"]
    share = {"sun": 1.0, "ring": ratio, "carrier": 1 + ratio}[driver]
    operation["input"] = driver
    slow = {"sun": 1.0, "ring": 0.6, "carrier": 0.4}
    operation["fixed" if alone else "second_input"] = other
    own = f"{numbers.number(0.9, 1.1) * slow[driver] * speed:.5g} rpm"
    operation["torque"] = signed(f"{share * torque:.5g} N*m", options["torque"])
    operation["speed"] = signed(own, options["speed"])
    if not alone:
        second = f"{numbers.number(0.2, 1.1) * slow[other] * speed:.5g} rpm"
        operation["second_speed"] = signed(second, numbers.rng.choice([1, -1]))
    operation["oil_inlet_temperature"] = numbers.text(-5, 125, "degC")


def draw_parts(tables: Tables, numbers: Numbers, options: Options, rack: Rack) -> None:
    """Bearings and carrier."""
    rng = numbers.rng
    if options["bearing_table"]:
        root = rack.module * tables["planet"]["teeth"] - 3.2 * rack.normal_module
        pin, roller = numbers.number(0.5, 0.62) * root, numbers.number(0.09, 0.17) * root
        most = math.pi / math.asin(roller / (pin + roller))
        rows = rng.choice([1, 2, 2, 3])
        width = value(tables["planet"]["face_width"])
        tables["planet_bearing"] = {
            "rows": rows,
            "rollers_per_row": max(3, math.floor(rng.uniform(0.6, 0.98) * most)),
            "roller_diameter": f"{roller:.4g} mm",
            "roller_length": f"{numbers.number(0.7, 0.95) * width / rows:.4g} mm",
            "pin_diameter": f"{pin:.5g} mm",
            "diametral_clearance": numbers.text(2, 30, "um"),
            "roller_roughness": f"{numbers.spread(0.05, 0.3)!r} um",
            "race_roughness": f"{numbers.spread(0.05, 0.3)!r} um",
        }
        if options["cage"] is not None:
            tables["planet_bearing"]["cage"] = options["cage"]
        if options["details"]:
            tables["planet_bearing"] |= {
                "viscous_factor": numbers.number(2, 9),
                "palmgren_coefficient": numbers.number(2e-4, 6e-4),
                "crown_drop": numbers.text(1, 6, "um"),
                "crown_length_fraction": numbers.number(0.1, 0.35),
                "row_gap": numbers.text(0.3, 1.9, "mm"),
                "material": draw_material(numbers),
            }
    distance = value(tables["gears"]["center_distance"])
    if options["carrier"]:
        tables["carrier"] = {
            "outer_diameter": f"{numbers.number(2.2, 2.9) * distance:.5g} mm",
            "width": f"{numbers.number(0.4, 0.9) * distance:.4g} mm",
        }
    if options["thrust"] is not None:
        tables["thrust_bearing"] = {
            "mean_diameter": f"{numbers.number(0.4, 1.1) * distance:.5g} mm",
            "between": options["thrust"],
        }
        if options["details"]:
            more = {"viscous_factor": numbers.number(2, 6), "count": rng.randint(2, 3)}
            tables["thrust_bearing"] |= more


def draw_sharing(numbers: Numbers, options: Options) -> Tables:
    """How the planets share the load."""
    method, count = options["sharing"], options["count"]
    if method is None:
        return {}
    tables: Tables = {"method": method}
    if method == "mesh-load-factor":
        tables["mesh_load_factor"] = numbers.number(1.02, 1.4) if count > 1 else 1.0
    if method in ("closed-form", "direct"):
        reach = 5 if method == "closed-form" else 20  # beyond which planets lose contact
        tables["position_errors"] = [numbers.text(-reach, reach, "um") for _ in range(count)]
        if options["floating"] is not None:
            tables["floating_member"] = options["floating"]
        if count == 1:
            tables["floating_member"] = "none"
        if method == "direct" and tables.get("floating_member") != "none":
            tables["support_stiffness"] = numbers.text(10, 300, "N/um")
        if options["details"]:
            tables["pin_stiffness"] = numbers.text(80, 600, "N/um")
    return tables


def settled(options: Options) -> Options:
    """Options of a planetary set without those that exclude each other."""
    found = dict(options)
    if found["tilt"] == "coupled":
        found |= {"bearing_table": True, "distribution": "compliance"}
    if found["sharing"] == "closed-form" and found["count"] < 3:
        found["sharing"] = "direct"
    if found["bearing"] == "mixed-ehl":
        found["cage"] = "caged"
    return found


# --- gear pairs -----------------------------------------------------------------------------------


def draw_pair(title: str, options: Options, rng: random.Random) -> Tables:
    """The tables of a gear pair, which may or may not be possible."""
    numbers = Numbers(rng)
    internal, side = options["internal"], -1 if options["internal"] else 1
    gears = draw_rack(numbers, options)
    rack = Rack(gears)
    module = rack.normal_module
    pinion = numbers.whole(16, 40)
    gear = numbers.whole(pinion + 22, 120) if internal else numbers.whole(18, 90)
    between = gear + side * pinion
    distance = float(f"{between * rack.module / 2 + rng.uniform(-0.1, 0.6) * module:.6g}")
    gears["center_distance"] = f"{distance!r} mm"
    own = rng.uniform(-0.15, 0.45)
    other = side * (rack.shifts(between, distance)) - own - rng.uniform(0.005, 0.08)
    width = numbers.spread(4 * module, 18 * module)
    tables: Tables = {"kind": "gear_pair", "title": title, "operation": {}, "gears": gears}
    for name, teeth, shift in (("pinion", pinion, own), ("gear", gear, other)):
        face = float(f"{numbers.number(0.9, 1.15) * width:.4g}")
        tables[name] = draw_gear(numbers, options, rack, teeth, shift, face)
        if options["micro_geometry"]:
            tables[name]["micro_geometry"] = draw_micro_geometry(numbers, module, face)
            if options["topography"] and name == "pinion":
                table = draw_topography(numbers, rack, teeth, shift, face)
                tables[name]["micro_geometry"]["topography"] = table
    if internal:
        tables["gear"]["internal"] = True
        if options["details"]:
            tables["gear"]["rim_thickness"] = numbers.text(2 * module, 6 * module, "mm")
    if options["misalignment"]:
        tables["mesh"] = {"misalignment": numbers.text(-7, 7, "um")}
    force = numbers.spread(3, 110) * module * width
    torque = force * pinion * rack.module / 2000
    speed = min(20000.0, numbers.spread(0.3, 30) * 60000 / (math.pi * pinion * rack.module))
    tables["operation"] = {
        "torque": signed(f"{torque:.5g} N*m", options["torque"]),
        "speed": signed(f"{speed:.5g} rpm", options["speed"]),
        "oil_inlet_temperature": numbers.text(-5, 125, "degC"),
    }
    tables |= draw_common(numbers, options)
    keys = {
        "friction": "friction", "rolling": "rolling", "load_distribution": "distribution",
        "mesh": "mesh", "pocketing": "pocketing",
    }  # fmt: skip
    tables["models"] = draw_models(numbers, options, keys)
    tables["numerics"] = draw_numerics(numbers, options)
    tables["losses"] = draw_losses(numbers, options, PAIR_LOSSES, ("mesh_pocketing",))
    return {key: table for key, table in tables.items() if table != {}}


# --- all of them ---------------------------------------------------------------------------------


def drawn_cases() -> Iterator[tuple[str, Tables]]:
    """Names and tables of the drawn cases, all of which can be read."""
    rng = random.Random(SEED)
    kinds = (
        ("planetary", PLANETARY, COMMON | OF_PLANETARY, draw_planetary, settled),
        ("pair", PAIRS, COMMON | OF_PAIRS, draw_pair, dict),
    )
    for kind, count, choices, draw, settle in kinds:
        decks = Decks(choices, rng)
        for number in range(1, count + 1):
            name = f"{kind}-{number:03}"
            options = settle(decks.draw())
            tables = possible(name, options, draw, rng)
            # every option in its full resolution would take too long
            if number % (count // 4) == 0:
                del tables["numerics"]
            yield name, tables


def possible(name: str, options: Options, draw: Any, rng: random.Random) -> Tables:
    """The first tables drawn that make a case."""
    for _ in range(ATTEMPTS):
        try:
            tables: Tables = draw(name, options, rng)
            ep.load_case(tables)
        except (ep.InputError, ValueError) as error:
            last = error
        else:
            return tables
    raise RuntimeError(f"{name}: {options}: {last}")
