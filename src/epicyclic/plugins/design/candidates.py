"""Candidates of a task: enumerated, screened by what is known without solving, written as cases.

Arrays over all candidates. A screen may only reject what the full computation would reject too, so
strengths are bounds: load factors are 1 but for K_A, and limits are higher than any case gets.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator, Mapping
from itertools import islice
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from epicyclic.arrays import FloatArray
from epicyclic.case.tables.strength import GearStrength, StrengthTable
from epicyclic.dataclass import dataclass
from epicyclic.errors import one_problem
from epicyclic.gears.gear import BasicRack
from epicyclic.gears.gearing import basic_rack
from epicyclic.gears.mesh import closing_number, profile_shift_sum
from epicyclic.plugins.design import iso_6336 as iso
from epicyclic.plugins.design.strength import Material, material_of
from epicyclic.plugins.design.task import DutyPoint, Task

Gears = dict[str, FloatArray]
Row = Mapping[str, Any]

BOUND_FRICTION = 0.012  # Less than any lubricated mesh has in its mean (estimate). [1]
BEST_LIMIT = 1.2  # Z_L Z_v Z_R at their best, about; Z_W is 1 for the harder gear. [1]
BEST_SOFT_LIMIT = 1.5  # The same if one of both gears is through-hardened. [1]
LEAST_ROOT = 2.0  # Y_F Y_S of any tooth, about. [1]
LEAST_HELIX = 0.75  # Y_beta. [1]
TIP_ROOM = 0.35  # Roll length between base circle of a planet and tip of its ring. [modules]
PIN, ROLLER = 0.8, 0.2  # Diameters of pin and rollers of planets over their root radius. [1]
BORE = PIN / 2 + ROLLER  # Radius of their bore over the same. [1]
COARSE = {"mesh_positions": 12, "contact_segments": 12, "bearing_slices": 10}
"""Numerics of designs, unless the task states others."""
STEEL, DENSITY = 206e9 / (1 - 0.3**2), 7850.0  # [Pa], [kg/m^3]


@dataclass(frozen=True, slots=True)
class MeshOf:
    """One mesh of an arrangement: its gears, and what it transmits for an input of 1."""

    first: str
    second: str
    internal: bool
    set: str  # "1" or "2": the stage.
    torque: Callable[[Gears], FloatArray]  # At the first gear, all planets together.
    speed: Callable[[Gears], FloatArray]  # Of the first gear against the carrier.


@dataclass(frozen=True, slots=True)
class Layout:
    """An arrangement of gears."""

    gears: tuple[str, ...]
    meshes: tuple[MeshOf, ...]
    ratio: Callable[[Gears], FloatArray]
    teeth: Callable[[Task], Iterator[tuple[int, ...]]]  # In the order of `gears`.


def _simple(z: Gears, one: str = "") -> FloatArray:
    return 1 + z[f"ring{one}"] / z[f"sun{one}"]


def _planetary_meshes(one: str, torque: Callable[[Gears], FloatArray]) -> tuple[MeshOf, MeshOf]:
    """Sun in, carrier out, ring held; `torque` of its sun over that of the input."""

    def speed(z: Gears) -> FloatArray:
        return (1 - 1 / _simple(z, one)) / torque(z)

    def planet(z: Gears) -> FloatArray:
        return z[f"planet{one}"] / z[f"sun{one}"]

    stage = one or "1"
    return (
        MeshOf(f"sun{one}", f"planet{one}", False, stage, torque, speed),
        MeshOf(f"planet{one}", f"ring{one}", True, stage,
               lambda z: torque(z) * planet(z), lambda z: speed(z) / planet(z)),
    )  # fmt: skip


def _teeth_of_set(low: int, high: int, ratio: float) -> Iterator[tuple[int, int, int]]:
    """Sun, planet and ring near a ratio: the ring has as many as sun and two planets."""
    for sun in range(low, high + 1):
        nearest = round(((ratio - 1) * sun - sun) / 2)
        for planet in range(max(12, nearest - 1), nearest + 2):
            yield sun, planet, sun + 2 * planet


def _pair_teeth(task: Task) -> Iterator[tuple[int, ...]]:
    low, high = task.choices.pinion_teeth
    for pinion in range(low, high + 1):
        wanted = round(task.ratio * pinion)
        for gear in range(max(low, wanted - 1), wanted + 2):
            yield pinion, gear


def _stepped_teeth(task: Task) -> Iterator[tuple[int, ...]]:
    low, high = task.choices.pinion_teeth
    for sun in range(low, high + 1):
        for wide in range(sun, 4 * sun + 1, 2):
            for narrow in range(max(low, wide // 3), wide):
                ring = sun + wide + narrow
                ratio = 1 + wide * ring / (sun * narrow)
                if abs(ratio / task.ratio - 1) < 2 * task.limits.ratio_error:
                    yield sun, wide, narrow, ring


def _wolfrom_teeth(task: Task) -> Iterator[tuple[int, ...]]:
    low, high = task.choices.pinion_teeth
    steps = [it for it in range(-task.choices.step, task.choices.step + 1) if it]
    for sun in range(low, high + 1):
        for wide in range(max(low, sun // 2), 4 * sun + 1):
            for step in steps:
                fixed = sun + 2 * wide
                if wide + step >= low:
                    yield sun, wide, wide + step, fixed, fixed + step


def _two_stage_teeth(task: Task) -> Iterator[tuple[int, ...]]:
    low, high = task.choices.pinion_teeth
    root = math.sqrt(task.ratio)
    for first in (0.85 * root, root, 1.15 * root):
        if min(first, task.ratio / first) < 2.5:
            continue
        for one in _teeth_of_set(low, high, first):
            second = task.ratio / (1 + one[2] / one[0])
            for sun in range(low, high + 1, 3):
                planet = round((second - 2) * sun / 2)
                if planet >= 12:
                    yield (*one, sun, planet, sun + 2 * planet)


def _whole(z: Gears) -> FloatArray:
    """All that the input has."""
    return np.ones(len(next(iter(z.values()))))


def _stepped_ratio(z: Gears) -> FloatArray:
    return 1 + z["wide"] * z["ring"] / (z["sun"] * z["narrow"])


def _wolfrom_ratio(z: Gears) -> FloatArray:
    train = z["fixed_ring"] * z["narrow"] / (z["wide"] * z["output_ring"])
    return (1 + z["fixed_ring"] / z["sun"]) / (1 - train)


def _wolfrom_speed(z: Gears) -> FloatArray:
    """Of the planet against the carrier, for an input of 1."""
    return (1 - 1 / (1 + z["fixed_ring"] / z["sun"])) * z["sun"] / z["wide"]


LAYOUTS: dict[str, Layout] = {
    "pair": Layout(
        ("pinion", "gear"),
        (MeshOf("pinion", "gear", False, "1", _whole, _whole),),
        lambda z: z["gear"] / z["pinion"],
        _pair_teeth,
    ),
    "planetary": Layout(
        ("sun", "planet", "ring"),
        _planetary_meshes("", _whole),
        _simple,
        lambda task: _teeth_of_set(*task.choices.pinion_teeth, task.ratio),
    ),
    "stepped": Layout(
        ("sun", "wide", "narrow", "ring"),
        (
            MeshOf("sun", "wide", False, "1", _whole, lambda z: 1 - 1 / _stepped_ratio(z)),
            MeshOf("narrow", "ring", True, "1", lambda z: z["wide"] / z["sun"],
                   lambda z: z["sun"] / z["wide"] * (1 - 1 / _stepped_ratio(z))),
        ),
        _stepped_ratio,
        _stepped_teeth,
    ),
    "wolfrom": Layout(
        ("sun", "wide", "narrow", "fixed_ring", "output_ring"),
        (
            MeshOf("sun", "wide", False, "1", _whole,
                   lambda z: 1 - 1 / (1 + z["fixed_ring"] / z["sun"])),
            MeshOf("wide", "fixed_ring", True, "1",
                   lambda z: np.abs(_wolfrom_ratio(z) - 1) * z["wide"] / z["fixed_ring"],
                   _wolfrom_speed),
            MeshOf("narrow", "output_ring", True, "1",
                   lambda z: np.abs(_wolfrom_ratio(z)) * z["narrow"] / z["output_ring"],
                   _wolfrom_speed),
        ),
        _wolfrom_ratio,
        _wolfrom_teeth,
    ),
    "two-stage": Layout(
        ("sun", "planet", "ring", "sun2", "planet2", "ring2"),
        (*_planetary_meshes("", _whole), *_planetary_meshes("2", _simple)),
        lambda z: _simple(z) * _simple(z, "2"),
        _two_stage_teeth,
    ),
}  # fmt: skip
"""By the names of `choices.arrangements`."""
SHARED = ("planets", "module", "helix", "shift", "distance_shift", "width_ratio", "module2")

MOST_TEETH = 1_000_000  # Combinations of teeth of an arrangement.


def enumerate_all(task: Task) -> tuple[pd.DataFrame, int]:
    """Candidates of a task, one a row: arrangement, teeth by gear, and what is shared.

    And how many combinations there are: of more than `Search.most_candidates` that many are drawn.
    """
    choices = [_Choices(task, name) for name in dict.fromkeys(task.choices.arrangements)]
    ends = np.cumsum([it.size for it in choices])
    total, most = int(ends[-1]), task.search.most_candidates
    if not total:
        stated = ", ".join(map(str, task.choices.pinion_teeth))
        told = f"allow no gears of the ratio {task.ratio:g}."
        remedy = "Allow more teeth or other arrangements."
        raise one_problem("choices.pinion_teeth", stated, told, remedy, task.title)
    numbers = np.arange(total)
    if total > most:
        numbers = np.sort(random.Random(task.search.seed).sample(range(total), most))
    parts = [
        it.rows(numbers[(numbers >= end - it.size) & (numbers < end)] - (end - it.size))
        for it, end in zip(choices, ends, strict=True)
    ]
    return pd.concat([it for it in parts if len(it)], ignore_index=True), total


class _Choices:
    """All combinations of an arrangement, made when they are asked for."""

    def __init__(self, task: Task, name: str) -> None:
        self.name, self.layout, choices = name, LAYOUTS[name], task.choices
        found = [*islice(self.layout.teeth(task), MOST_TEETH + 1)]
        if len(found) > MOST_TEETH:
            stated = ", ".join(map(str, choices.pinion_teeth))
            told = f"allow more than {MOST_TEETH:,} combinations of teeth, arrangement {name}."
            remedy = "Narrow it, as in [17, 35]."
            raise one_problem("choices.pinion_teeth", stated, told, remedy, task.title)
        self.teeth = np.array(found, dtype=float).reshape(-1, len(self.layout.gears))
        planets = (1,) if name == "pair" else choices.planets
        later = choices.module if "sun2" in self.layout.gears else (math.nan,)
        self.axes = (
            planets, choices.module, choices.helix_angle, choices.profile_shift,
            choices.distance_shift, choices.width_ratio, later,
        )  # fmt: skip
        self.shape = (len(self.teeth), *map(len, self.axes))
        self.size = math.prod(self.shape)

    def rows(self, numbers: NDArray[np.int64]) -> pd.DataFrame:
        """Some of them."""
        first, *places = np.unravel_index(numbers, self.shape) if self.size else [numbers] * 8
        columns = {gear: self.teeth[first, at] for at, gear in enumerate(self.layout.gears)}
        columns |= {
            key: np.array(values, dtype=float)[place]
            for place, key, values in zip(places, SHARED, self.axes, strict=True)
        }
        return pd.DataFrame({"arrangement": self.name, **columns})


@dataclass(frozen=True, slots=True)
class Sizes:
    """What follows of some candidates of one arrangement without solving; lengths in metres."""

    ratio: FloatArray
    diameter: FloatArray
    width: FloatArray
    mass: FloatArray
    backlash: FloatArray  # Play of the output with the input held. [rad]
    margins: dict[str, FloatArray]  # By the limit: what is over what must be, 1 or more is met.
    loss: FloatArray  # Less than the load-dependent loss over the cycle can be. [W]


def ring_tip(usual: Any, base: Any, action: Any, module: Any) -> Any:
    """Tip radius of a ring: the usual one, or that which leaves the involute of the planet. [m]"""
    return np.maximum(usual, np.hypot(base, action + TIP_ROOM * module))


def distances(table: pd.DataFrame, stage: str = "1") -> FloatArray:
    """Centre distance of a stage of candidates of one arrangement. [m]"""
    meshes = LAYOUTS[str(table["arrangement"].iloc[0])].meshes
    mesh = next(it for it in meshes if it.set == stage)
    module = table["module2" if stage == "2" else "module"].to_numpy()
    teeth = (table[mesh.first] + table[mesh.second]).to_numpy()
    total = teeth / (2 * np.cos(table["helix"].to_numpy()))
    found: FloatArray = module * (total + table["distance_shift"].to_numpy())
    return found


def sizes(task: Task, table: pd.DataFrame) -> Sizes:
    """Sizes and bounds of the candidates of one arrangement."""
    name = str(table["arrangement"].iloc[0])
    layout = LAYOUTS[name]
    z = {gear: table[gear].to_numpy() for gear in layout.gears}
    helix, planets = table["helix"].to_numpy(), table["planets"].to_numpy()
    alpha_n = task.choices.pressure_angle
    alpha_t = np.arctan(math.tan(alpha_n) / np.cos(helix))
    inv_t = np.tan(alpha_t) - alpha_t
    base_helix = np.arctan(np.tan(helix) * np.cos(alpha_t))
    ratio = layout.ratio(z)
    strength = StrengthTable.model_validate(task.case.get("strength", {}))
    margins: dict[str, FloatArray] = {}

    def least(key: str, values: FloatArray) -> None:
        margins[key] = np.minimum(margins.get(key, np.full(len(table), np.inf)), values)

    with np.errstate(all="ignore"):
        error = np.abs(np.abs(ratio) / task.ratio - 1)
        allowed = max(task.limits.ratio_error, 1e-9)
        least("ratio_error", np.where(error <= allowed, 1.0, allowed / np.maximum(error, 1e-12)))
        diameter, mass, backlash, loss = (np.zeros(len(table)) for _ in range(4))
        powers = sum(point.share * point.torque * point.speed for point in task.points)
        power = abs(powers) / sum(point.share for point in task.points)
        shifts: Gears = {}
        modules, faces = {}, {}  # By the stage.
        for stage, pinion in {"1": layout.gears[0], "2": "sun2"}.items():
            if pinion in z:
                modules[stage] = table["module2" if stage == "2" else "module"].to_numpy()
                faces[stage] = table["width_ratio"].to_numpy() * modules[stage] * z[pinion]
                faces[stage] = faces[stage] / np.cos(helix)
        for mesh in layout.meshes:
            module, face = modules[mesh.set], faces[mesh.set]
            distance = distances(table, mesh.set)
            sign = -1.0 if mesh.internal else 1.0
            z1, z2 = z[mesh.first], z[mesh.second]
            transverse = module / np.cos(helix)
            bases = transverse * np.cos(alpha_t) / 2
            cosine = (z2 + sign * z1) * bases / distance
            angle = np.arccos(np.clip(cosine, -1, 1))
            total = (np.tan(angle) - angle - inv_t) * (z2 + sign * z1) * sign
            total = total / (2 * math.tan(alpha_n)) - task.choices.backlash / (
                2 * module * math.sin(alpha_n)
            )
            x1 = shifts.setdefault(mesh.first, table["shift"].to_numpy())
            x2 = shifts.setdefault(mesh.second, total - x1)
            r1, r2 = z1 * transverse / 2, z2 * transverse / 2
            tip1, tip2 = r1 + module * (x1 + 1), r2 + sign * module * (x2 + 1)
            action, point = distance * np.sin(angle), np.abs(z1 * bases) * np.tan(angle)
            if mesh.internal:
                tip2 = ring_tip(tip2, z2 * bases, action, module)
            roll1 = np.sqrt(np.maximum(0, tip1**2 - (z1 * bases) ** 2))
            roll2 = np.sqrt(np.maximum(0, tip2**2 - (z2 * bases) ** 2))
            pitch = math.pi * transverse * np.cos(alpha_t)
            start = np.maximum(sign * (action - roll2), 0.0)
            eps1, eps2 = (roll1 - point) / pitch, (point - start) / pitch
            alpha = eps1 + eps2
            overlap = face * np.tan(base_helix) / pitch
            least("contact_ratio", (alpha + overlap) / task.limits.contact_ratio)
            is_mesh = (np.abs(cosine) <= 1) & (alpha > 0.5) & np.isfinite(alpha)
            least("mesh", np.where(is_mesh, 1.0, 0.0))
            # tips; those of rings are wide
            for count, x, outer in ((z1, x1, tip1), (z2, x2, tip2))[: 1 if mesh.internal else 2]:
                tip_angle = np.arccos(np.clip(count * bases / outer, -1, 1))
                half = (math.pi / 2 + 2 * x * math.tan(alpha_n)) / count + inv_t
                half -= np.tan(tip_angle) - tip_angle
                tip = 2 * outer * half * np.cos(helix) / module
                margin = np.clip(tip / max(task.limits.tip_thickness, 1e-9), 0, 10)
                least("tip_thickness", margin)
            # bounds of loss and strength
            carried = mesh.torque(z)
            turning = mesh.speed(z)
            # virtual work: the play of a mesh moves the output as its force loads it
            play = task.choices.backlash / np.cos(base_helix)
            backlash += np.abs(carried / (z1 * bases * ratio)) * play
            # Ohlendorf's loss factor
            factor = math.pi * (z2 + sign * z1) / (z1 * z2 * np.cos(base_helix))
            factor = np.abs(factor) * (1 - alpha + eps1**2 + eps2**2)
            loss += BOUND_FRICTION * power * np.abs(carried * turning) * np.maximum(factor, 0)
            tangential = np.abs(carried) * task.operation.torque / planets / r1
            tangential = tangential * strength.application_factor
            zone = np.sqrt(2 * np.cos(base_helix) / np.tan(angle)) / np.cos(alpha_t)
            beta = np.minimum(overlap, 1)
            sharing = np.sqrt(
                np.maximum((4 - alpha) / 3, 0.2) * (1 - beta) + beta / np.maximum(alpha, 0.5)
            )
            load = tangential / (2 * r1 * face) * (z2 + sign * z1) / z2
            stress = zone * iso.elasticity_factor(STEEL) * sharing * np.sqrt(load)
            slow = np.abs(turning) * task.operation.speed * strength.life / (2 * math.pi)
            cycles = slow * np.minimum(1.0, z1 / z2)  # of the gear that turns less
            bears = [_material(strength, it) for it in (mesh.first, mesh.second)]
            soft = any(it.treatment == "through-hardened" for it in bears)
            if task.limits.pitting:
                lives = [iso.life_factor(cycles, iso.PITTING_LIFE[it.treatment]) for it in bears]
                factor = BEST_SOFT_LIMIT if soft else BEST_LIMIT
                best = factor * max(it.contact for it in bears) * np.maximum(*lives)
                least("pitting", best / stress / task.limits.pitting)
            if task.limits.bending:
                bent = tangential / (face * module) * LEAST_ROOT * LEAST_HELIX
                lives = [iso.life_factor(cycles, iso.BENDING_LIFE[it.treatment]) for it in bears]
                best = 2 * 1.1 * max(it.bending for it in bears) * np.maximum(*lives)
                least("bending", best / bent / task.limits.bending)
            planet_tip = tip1 if mesh.internal else tip2  # of the planet, if there is one
            if mesh.internal:
                outside = 2 * (r2 + module * (1.25 - x2 + 3))
            elif name == "pair":
                outside = tip1 + tip2 + distance
            else:
                outside = 2 * (distance + tip2)
            if name != "pair":
                side = 2 * distance * np.sin(math.pi / planets)
                room = np.where(planets > 1, (side - 0.2 * module) / (2 * planet_tip), np.inf)
                least("planets_touch", room)
            diameter = np.maximum(diameter, outside)
        for gear in layout.gears:
            stage = "2" if gear.endswith("2") else "1"
            module = modules[stage]
            radius = z[gear] * module / np.cos(helix) / 2
            x = shifts[gear]
            turns = gear.startswith(("planet", "wide", "narrow"))
            number = planets if turns else 1
            area = (radius + module * (x - 0.125)) ** 2  # teeth to half their depth
            if "ring" in gear:
                area = (radius + module * (4.25 - x)) ** 2 - (radius + module * (0.125 - x)) ** 2
            elif turns and task.choices.bearings:
                smaller = np.minimum(z.get("wide", z[gear]), z.get("narrow", z[gear]))
                area -= (BORE * (smaller / 2 - 1.25) * module) ** 2
            mass += number * math.pi * area * faces[stage] * DENSITY
        width = sum(faces.values()) * (2 if "wide" in z else 1)  # A stepped planet has two widths.
        known = {"diameter": diameter, "width": width, "mass": mass, "backlash": backlash}
        for key, found in known.items():
            limit = getattr(task.limits, key)
            if limit is not None:
                least(key, limit / found)
        least("assembly", _assembly(layout, z, planets))
    met = {key: np.nan_to_num(values) for key, values in margins.items()}
    return Sizes(ratio, **known, margins=met, loss=loss)


def _assembly(layout: Layout, z: Gears, planets: FloatArray) -> FloatArray:
    """1 where alike planets fit at equal angles, else 0; see `closing_number`."""
    teeth = np.column_stack([z[gear] for gear in layout.gears]).astype(int)
    kinds, places = np.unique(teeth, axis=0, return_inverse=True)
    fits = np.ones(len(planets), dtype=bool)
    for stage in {mesh.set for mesh in layout.meshes}:
        numbers = np.array([_closing(layout, stage, kind) for kind in kinds])[places.ravel()]
        fits &= numbers % planets == 0
    return np.where(fits, 1.0, 0.0)


def _closing(layout: Layout, stage: str, kind: Any) -> int:
    """N of the planets of a stage, 0 of gears on fixed axes."""
    own = dict(zip(layout.gears, map(int, kind), strict=True))
    meshes = []
    for mesh in layout.meshes:
        if mesh.set == stage:
            one, two = own[mesh.first], own[mesh.second]
            meshes.append(({"planet": one}, -two) if mesh.internal else ({"planet": two}, one))
    return closing_number(meshes)


def _material(table: StrengthTable, gear: str) -> Material:
    """The strongest that the task states for a gear, whatever its set is called."""
    own = gear.removesuffix("2")
    stated = [it for name, it in table.gears.items() if name.split(".")[-1] == own]
    return max(map(material_of, stated or [GearStrength()]), key=lambda it: it.contact)


# A candidate as a case.


def _mm(value: float) -> str:
    return f"{1e3 * value:.6g} mm"


def operation(point: DutyPoint) -> dict[str, str]:
    """What a case states of an operating point."""
    return {
        "torque": f"{point.torque:.9g} N*m",
        "speed": f"{point.speed * 30 / math.pi:.9g} rpm",
        "oil_inlet_temperature": f"{point.oil_inlet_temperature - 273.15:.6g} degC",
    }


def case_tables(task: Task, row: Row, point: int = -1) -> dict[str, Any]:
    """The tables of a candidate's case, at the operating point or at one of the cycle."""
    name = str(row["arrangement"])
    at = operation(task.operation if point < 0 else task.points[point])
    common = {"numerics": COARSE} | dict(task.case) | _strength_tables(task, name)
    title = {"title": f"{task.title or 'design'}: {name} {teeth_text(row)}"}
    if name == "pair":
        own = _set_tables(task, row, "1")
        return title | {"kind": "gear_pair", "operation": at} | own | common
    if name == "planetary":
        own = _set_tables(task, row, "1")
        ends = {"input": "sun", "fixed": "ring"}
        return title | {"kind": "planetary", "operation": ends | at} | own | common
    train = title | {"kind": "train", "operation": {"input": "in", "output": "out"} | at}
    if name == "two-stage":
        sets = {"A": _set_tables(task, row, "1"), "B": _set_tables(task, row, "2")}
        shafts = {
            "in": ["A.sun"], "middle": ["A.carrier", "B.sun"], "out": ["B.carrier"],
            "housing": ["A.ring", "B.ring"],
        }  # fmt: skip
        return train | {"sets": sets, "shafts": shafts} | common
    own = _listed_tables(task, row)
    held, out = ("ring", "carrier") if name == "stepped" else ("fixed_ring", "output_ring")
    shafts = {"in": ["S.sun"], "out": [f"S.{out}"], "housing": [f"S.{held}"]}
    return train | {"sets": {"S": own}, "shafts": shafts} | common


def _strength_tables(task: Task, name: str) -> dict[str, Any]:
    """[strength] with the gears of this arrangement by the names that its case gives them."""
    stated = stated_gears(task)
    if not stated:
        return {}
    sets = {"two-stage": ("A.", "B."), "stepped": ("S.",), "wolfrom": ("S.",)}.get(name, ("",))
    own = {gear.removesuffix("2") for gear in LAYOUTS[name].gears}
    gears = {f"{one}{gear}": table for gear, table in stated.items() if gear in own for one in sets}
    return {"strength": task.case["strength"] | {"gears": gears}}


def stated_gears(task: Task) -> Mapping[str, Any]:
    """What [strength] of all cases says of gears; nothing if that is no table."""
    strength = task.case.get("strength")
    gears = strength.get("gears") if isinstance(strength, Mapping) else None
    return gears if isinstance(gears, Mapping) else {}


def teeth_text(row: Row) -> str:
    """``"21/27/75"``."""
    gears = LAYOUTS[str(row["arrangement"])].gears
    return "/".join(f"{int(row[gear])}" for gear in gears)


def _shared(task: Task, row: Row, stage: str) -> tuple[dict[str, str], BasicRack, float, float]:
    """Keys of all gears of a stage, their rack, centre distance and face width. [m]"""
    module = float(row["module2" if stage == "2" else "module"])
    helix = float(row["helix"])
    distance = float(distances(pd.DataFrame([dict(row)]).dropna(axis=1), stage)[0])
    alpha_n = task.choices.pressure_angle
    rack = basic_rack(helix, module, normal_pressure_angle=alpha_n)
    tables = {
        "normal_module": _mm(module),
        "normal_pressure_angle": f"{math.degrees(alpha_n):.9g} deg",
        "helix_angle": f"{math.degrees(helix):.9g} deg",
        "center_distance": f"{1e3 * distance:.9g} mm",
    }
    first = next(it.first for it in LAYOUTS[str(row["arrangement"])].meshes if it.set == stage)
    width = float(row["width_ratio"]) * int(row[first]) * rack.transverse_module
    return tables, rack, distance, width


def _gears(
    task: Task, row: Row, stage: str, rack: BasicRack, distance: float, width: float
) -> dict[str, dict[str, Any]]:
    """The tables of the gears of a stage: x of the sun as chosen, the others close their meshes.

    Rings have tips that leave the planets' involutes.
    """
    module, transverse = rack.normal_module, rack.transverse_module
    bases = transverse * math.cos(rack.transverse_pressure_angle) / 2
    shifts: dict[str, float] = {}
    tips: dict[str, dict[str, str]] = {}
    for mesh in LAYOUTS[str(row["arrangement"])].meshes:
        if mesh.set != stage:
            continue
        one, two = int(row[mesh.first]), int(row[mesh.second])
        teeth = one - two if mesh.internal else one + two
        first = shifts.setdefault(mesh.first, float(row["shift"]))
        try:
            total = profile_shift_sum(rack, teeth, distance, task.choices.backlash)
        except ValueError as error:
            remedy = "Choose another one."
            raise one_problem("design", teeth_text(row), str(error), remedy, task.title) from None
        second = shifts.setdefault(mesh.second, total - first)
        if mesh.internal:
            usual = two * transverse / 2 - module * (1 + round(second, 9))
            action = math.sqrt(max(0.0, distance**2 - (teeth * bases) ** 2))
            tip = float(ring_tip(usual, two * bases, action, module))
            tips[mesh.second] = {"tip_diameter": _mm(2 * tip)}
    return {
        gear: {
            "teeth": int(row[gear]),
            "face_width": _mm(width),
            "profile_shift_coefficient": round(shift, 9),
            "roughness": task.choices.roughness,
        }
        | tips.get(gear, {})
        for gear, shift in shifts.items()
    }


def _planet_tables(
    task: Task, teeth: int, rack: BasicRack, distance: float, width: float
) -> dict[str, Any]:
    """Bearing and carrier, in proportion to planet and centre distance."""
    root = (teeth / 2 - 1.25) * rack.normal_module
    tables: dict[str, Any] = {
        "carrier": {"outer_diameter": _mm(2 * (distance + 0.7 * root)), "width": _mm(1.4 * width)}
    }
    if task.choices.bearings:
        pin, roller = PIN * root, ROLLER * root
        tables["planet_bearing"] = {
            "rows": 2,
            "rollers_per_row": max(8, int(0.85 * math.pi * (pin + roller) / roller)),
            "roller_diameter": _mm(roller),
            "roller_length": _mm(0.38 * width),
            "pin_diameter": _mm(pin),
            "diametral_clearance": _mm(6e-4 * pin + 5e-6),
            "roller_roughness": "0.1 um",
            "race_roughness": "0.15 um",
        }
    return tables


def _set_tables(task: Task, row: Row, stage: str) -> dict[str, Any]:
    """A pair, or a planetary set."""
    shared, rack, distance, width = _shared(task, row, stage)
    made = _gears(task, row, stage, rack, distance, width)
    tables: dict[str, Any] = {"gears": shared}
    tables |= {gear.removesuffix("2"): table for gear, table in made.items()}
    if "planet" not in tables:
        return tables | {"losses": _losses(task, ("mesh",))}
    tables["losses"] = _losses(task, ("sun_mesh", "ring_mesh"))
    tables["planet"]["count"] = int(row["planets"])
    return tables | _planet_tables(task, tables["planet"]["teeth"], rack, distance, width)


def _losses(task: Task, meshes: tuple[str, ...]) -> dict[str, Any]:
    """Pocketing is left out where the task does not ask for it."""
    left_out = {"include": False}
    return {} if task.choices.pocketing else {f"{mesh}_pocketing": left_out for mesh in meshes}


def _listed_tables(task: Task, row: Row) -> dict[str, Any]:
    """A stepped or a Wolfrom set."""
    layout = LAYOUTS[str(row["arrangement"])]
    shared, rack, distance, width = _shared(task, row, "1")
    gears: dict[str, Any] = shared | _gears(task, row, "1", rack, distance, width)
    for gear in layout.gears:
        if gear in ("wide", "narrow"):
            gears[gear]["body"] = "planet"
        if "ring" in gear:
            gears[gear]["internal"] = True
    smaller = min(gears["wide"]["teeth"], gears["narrow"]["teeth"])
    return {
        "planets": int(row["planets"]),
        "meshes": [[mesh.first, mesh.second] for mesh in layout.meshes],
        "gears": gears,
        "losses": _losses(task, tuple(f"{it.first}_{it.second}_mesh" for it in layout.meshes)),
        **_planet_tables(task, smaller, rack, distance, 2 * width),
    }
