"""The strength of a case beside its losses: pitting, bending, micropitting, scuffing, bearings."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, cast

import numpy as np

from epicyclic import library
from epicyclic.arrays import FloatArray
from epicyclic.build.machine import Built
from epicyclic.build.result import NOT_INCLUDED, assemble
from epicyclic.case.case import Case
from epicyclic.case.tables.strength import GearStrength, StrengthTable
from epicyclic.contact.elastic_teeth import LoadedMesh
from epicyclic.contact.temperatures import (
    LUBRICATION_FACTORS,
    bulk_rise_of_flash,
    bulk_rise_of_loss,
    mates_factor,
)
from epicyclic.dataclass import dataclass, replace
from epicyclic.errors import Problem, raise_any
from epicyclic.gears.flanks import RA_OVER_RQ, RZ_OVER_RA
from epicyclic.gears.gear import Gear
from epicyclic.gears.measures import flank_tolerances
from epicyclic.gears.mesh import Mesh
from epicyclic.losses.contact import LineLoads, MeshContact
from epicyclic.losses.designations import RATING_BAND
from epicyclic.losses.mesh import flash_temperatures
from epicyclic.losses.shaft_bearing import CatalogueBearing
from epicyclic.machine.element import State, joined_key, note_watts
from epicyclic.machine.gear_mesh import MeshDuty, contact_under, distribute_load, elastic_loads
from epicyclic.machine.gear_set import GearSet
from epicyclic.machine.planets import PlanetBearing, rated
from epicyclic.machine.shaft_parts import ShaftBearing
from epicyclic.messages import did_you_mean
from epicyclic.oil.oil import Oil, oil_state
from epicyclic.plugins.design import iso_6336 as iso
from epicyclic.plugins.design import lubricated
from epicyclic.plugins.design.bearing_life import BearingRating, bearing_rating, dynamic_load
from epicyclic.plugins.design.mass import gear_body
from epicyclic.study.load import CaseSource, as_case
from epicyclic.study.solve import build_computed
from epicyclic.units import percent

FACE_BINS = 8  # Parts of the face over which the load is averaged for K_Hbeta.
MATERIAL_STIFFNESS = 0.8  # C_M of ISO 6336-1: measured over theoretical stiffness. [1]
AFTER = {
    "pitting": "after ISO 6336-2: stresses and factors of method B, without static strength",
    "bending": "after ISO 6336-3: method B, without thin rims, protuberance and grinding notches",
    "loads": "after ISO 6336-1: K_v and K_Halpha of method B, K_Hbeta from the computed load",
    "micropitting": "after ISO/TS 6336-22: film thickness at the computed pressure and friction",
    "scuffing": "after ISO/TS 6336-20, -21: limits for the computed flash temperatures",
    "bearings": "after ISO 281: basic and modified life, 90 %, without misalignment",
}
"""What the numbers are, and which parts are covered."""


@dataclass(frozen=True, slots=True)
class Material:
    """What one gear bears, with its own and the default values."""

    name: str
    treatment: iso.Treatment
    contact: float  # sigma_Hlim. [Pa]
    bending: float  # sigma_Flim. [Pa]
    hardness: float  # Vickers.
    slip_layer: float  # rho'. [m]


def material_of(table: GearStrength) -> Material:
    """The class of a gear, with what its table states."""
    entry = library.strength_table()["materials"][table.material]
    hardness = table.hardness or entry["hardness"][0]

    def limit(kind: str) -> float:
        slope, start = entry[kind]
        return float(slope * hardness + start) * 1e6

    return Material(
        name=table.material,
        treatment=entry["treatment"],
        contact=table.contact_strength or limit("contact"),
        bending=table.bending_strength or limit("bending"),
        hardness=hardness,
        slip_layer=float(entry["slip_layer"].split()[0]) / iso.MM,
    )


def load_stages(table: StrengthTable, oil: Oil) -> tuple[int, int, str]:
    """Failure load stages of the oil in scuffing and micropitting, and where they are from."""
    known = library.strength_table()["oils"][oil.kind]
    own = table.scuffing_stage, table.micropitting_stage
    source = "as stated" if all(own) else known["source"]
    return own[0] or known["scuffing_stage"], own[1] or known["micropitting_stage"], source


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadFactors:
    """Factors on the nominal load of a mesh. [1]"""

    application: float  # K_A.
    sharing: float  # K_gamma.
    dynamic: float  # K_v.
    face: float  # K_Hbeta, as stated or computed.
    face_computed: float  # K_Hbeta of the computed load along the contact lines.
    transverse: float  # K_Halpha.
    transverse_bending: float  # K_Falpha.
    face_bending: float  # K_Fbeta.

    @property
    def common(self) -> float:
        """K_A K_gamma K_v."""
        return self.application * self.sharing * self.dynamic

    @property
    def contact(self) -> float:
        """All that load the flanks."""
        return self.common * self.face * self.transverse

    @property
    def bending(self) -> float:
        """All that load the roots."""
        return self.common * self.face_bending * self.transverse_bending


@dataclass(frozen=True, slots=True, kw_only=True)
class GearRating:
    """Pitting and bending of one gear in one mesh."""

    gear: str
    cycles: float
    material: str
    contact_stress: float  # sigma_H at the inner point of single contact. [Pa]
    contact_limit: float  # sigma_HG. [Pa]
    form_factor: float  # Y_F. [1]
    stress_correction: float  # Y_S. [1]
    nominal_root_stress: float  # sigma_F0. [Pa]
    root_stress: float  # sigma_F. [Pa]
    root_limit: float  # sigma_FG. [Pa]

    @property
    def pitting(self) -> float:
        """S_H. [1]"""
        return self.contact_limit / self.contact_stress

    @property
    def bending(self) -> float:
        """S_F. [1]"""
        return self.root_limit / self.root_stress


@dataclass(frozen=True, slots=True, kw_only=True)
class FlankRating:
    """Micropitting and scuffing of one mesh; temperatures in kelvin, NaN without motion."""

    bulk_temperature: float
    film_ratio: float  # Smallest lambda_GFY. [1]
    film_ratio_limit: float  # lambda_GFP. [1]
    micropitting_place: float  # On the path of contact from the pitch point. [m]
    contact_temperature: float  # theta_B, highest. [K]
    scuffing_temperature: float  # theta_S. [K]
    integral_temperature: float  # theta_int. [K]
    integral_scuffing_temperature: float  # theta_intS. [K]
    micropitting: float  # S_lambda. [1]
    scuffing: float  # S_B. [1]
    integral_scuffing: float  # S_intS. [1]


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshRating:
    """Safeties of one mesh."""

    key: str
    factors: LoadFactors
    nominal_contact_stress: float  # sigma_H0. [Pa]
    tangential_force: float  # F_t of one mesh, nominal. [N]
    gears: tuple[GearRating, GearRating]
    flanks: FlankRating


@dataclass(frozen=True, slots=True)
class Strength:
    """Safeties of a case at its operating point."""

    meshes: tuple[MeshRating, ...]
    bearings: tuple[BearingRating, ...]
    stages: tuple[int, int]  # Failure load stages of the oil, scuffing and micropitting.
    stages_source: str
    notes: tuple[str, ...]  # What is missing or estimated.

    def least(self) -> dict[str, float]:
        """The smallest safety of each kind, and the shortest life of a bearing in hours."""
        values = {
            name: [getattr(gear, name) for mesh in self.meshes for gear in mesh.gears]
            for name in ("pitting", "bending")
        } | {
            name: [getattr(mesh.flanks, name) for mesh in self.meshes]
            for name in ("micropitting", "scuffing", "integral_scuffing")
        }
        values["bearing_life"] = [one.modified_life / 3600 for one in self.bearings]
        # NaN as of flanks at rest and of bearings without a static load rating
        known = {name: [it for it in own if not math.isnan(it)] for name, own in values.items()}
        return {name: min(own) for name, own in known.items() if own}


def strength(case: CaseSource) -> Strength:
    """Safeties of the gears and lives of the bearings of a case.

    The names say which standards are followed; none is followed in full, see
    ``epicyclic strength --help``.

    Parameters
    ----------
    case : PlanetaryCase, GearPairCase or TrainCase
        Its table ``[strength]`` states lives, factors and materials; without it defaults hold.

    Returns
    -------
    Strength
        For every mesh under load, of a planetary set of its most loaded planet.

    Raises
    ------
    InputError
        If the case is a train of given efficiencies.
    ConvergenceError
        If the machine has no solution.

    Examples
    --------
    >>> import epicyclic as ep
    >>> found = ep.strength(ep.load_case("talbot-2012"))  # doctest: +SKIP
    >>> [mesh.key for mesh in found.meshes]  # doctest: +SKIP
    ['sun_mesh', 'ring_mesh']
    """
    case = as_case(case)
    built, table = build_computed(case), case.strength or StrengthTable()
    raise_any(dict.fromkeys(_problems(case, table, built)), case.source)
    settled = built.solve()
    state = settled.solution.state
    assert case.lubricant is not None
    oil = case.lubricant.oil
    scuffing, micropitting, source = load_stages(table, oil)
    rating = _Rating(case, table, state, oil, (scuffing, micropitting))
    meshes: list[MeshRating] = []
    bearings: list[BearingRating] = []
    for name, own in built.sets.items():
        mean = {duty.gears.key: duty for duty in own.mean_duties(state)}
        for duty in own.loaded_duties(state):
            if duty.torque1 != 0:
                key = duty.gears.key
                meshes.append(rating.mesh(name, own, duty, abs(mean[key].torque1)))
        bearings += rating.planet_bearings(name, own)
    shafts = [one for one in built.machine.elements if isinstance(one, ShaftBearing)]
    bearings += rating.shaft_bearings(shafts)
    notes = [
        it
        for it in assemble(case, built, settled).notes
        if math.isinf(note_watts(it)) and not it.startswith(NOT_INCLUDED)
    ]
    notes += _about_ratings(shafts)
    if not meshes:
        notes.insert(0, "no mesh carries a load here, so none has a safety")
    return Strength(tuple(meshes), tuple(bearings), (scuffing, micropitting), source, tuple(notes))


def _about_ratings(shafts: Sequence[ShaftBearing]) -> Iterator[str]:
    """Shaft bearings by what their lives lack."""
    estimated = f"ratings estimated, ±{percent(RATING_BAND, 0)}, and lives go with C^3"
    lacks: dict[str, Callable[[CatalogueBearing], bool]] = {
        "no life without dynamic_load_rating": lambda it: math.isnan(it.dynamic_load_rating),
        "no modified life without static_load_rating": lambda it: math.isnan(it.static_load_rating),
        estimated: lambda it: bool(it.estimated),
    }
    for words, is_lacking in lacks.items():
        keys = [one.key for one in shafts if is_lacking(one.bearing)]
        if keys:
            yield f"{words}: {', '.join(keys)}"


def _problems(case: Case, table: StrengthTable, built: Built) -> Iterator[Problem]:
    """What the case does not have, and hardnesses that no steel of the class has."""
    meshes = {
        joined_key(name, it.key): own for name, own in built.sets.items() for it in own.meshes
    }
    for name in table.meshes.keys() - meshes.keys():
        remedy = did_you_mean(name, meshes) or f"Name one of {', '.join(meshes)}."
        yield Problem(f"strength.meshes.{name}", "", "is no mesh of the case.", remedy)
    for mesh, of in meshes.items():
        apart = getattr(table.meshes.get(mesh), "mesh_load_factor", None)
        factor = apart or table.mesh_load_factor or 0.0
        if of.planets and factor > of.count:
            key = f"strength.{f'meshes.{mesh}.' if apart else ''}mesh_load_factor"
            allowed = f"must be at most {of.count}, with which one of the planets carries all load."
            yield Problem(key, f"{factor:g}", allowed, "Use a smaller factor.")
    known = [
        joined_key(name, gear) for name, gearing in case.gearings.items() for gear in gearing.tables
    ]
    for name, own in table.gears.items():
        if name not in known:
            remedy = did_you_mean(name, known) or f"Name one of {', '.join(known)}."
            yield Problem(f"strength.gears.{name}", "", "is no gear of the case.", remedy)
        _, low, high = library.strength_table()["materials"][own.material]["hardness"]
        if own.hardness is not None and not low <= own.hardness <= high:
            allowed = f"must be {low:g} to {high:g} for {own.material}."
            remedy = (
                f"Give such a hardness, {min(max(own.hardness, low), high):g}, or the strengths."
            )
            yield Problem(f"strength.gears.{name}.hardness", f"{own.hardness:g}", allowed, remedy)


def face_load_factor(loads: LineLoads, mesh: Mesh) -> float:
    """Largest load per face width over its mean: K_Hbeta of a computed load. ISO 6336-1, Eq. 40.

    Means over parts of the face, every segment spread over its own width, and the straight
    continuation of the last two to each end.
    """
    lines = loads.lines
    force = lines.weight[:, None, None] * lines.length * loads.line_load
    force, middle, length = (it[force > 0] for it in (force, lines.face_position, lines.length))
    width = length * math.cos(mesh.gear1.rack.base_helix_angle)
    edges = np.linspace(0.0, mesh.face_width, FACE_BINS + 1)[:, None]
    below = np.clip((edges - middle) / width + 0.5, 0.0, 1.0) @ force
    per_width = np.diff(below) / np.diff(below).mean()
    ends = 1.5 * per_width[[0, -1]] - 0.5 * per_width[[1, -2]]
    return float(max(1.0, per_width.max(), ends.max()))


@dataclass(frozen=True, slots=True)
class _Rating:
    """What the ratings of all meshes share."""

    case: Case
    table: StrengthTable
    state: State
    oil: Oil
    stages: tuple[int, int]

    def mesh(self, name: str, own: GearSet, duty: MeshDuty, mean_torque: float) -> MeshRating:
        """One mesh of a set; `mean_torque` of a planet with its mean share."""
        mesh, key = duty.gears.mesh, joined_key(name, duty.gears.key)
        loads = distribute_load(duty)
        elastic = loads.elastic or elastic_loads(duty)
        sharing = self._stated(key, "mesh_load_factor") or abs(duty.torque1) / mean_torque
        nominal = mean_torque / mesh.gear1.reference_radius
        limits = [material_of(self._own(name, gear)) for gear in mesh.gears]
        factors = self._factors(name, own, duty, loads, elastic, nominal, sharing, limits)
        scale = mean_torque * factors.common / abs(duty.torque1)
        return MeshRating(
            key=key,
            factors=factors,
            nominal_contact_stress=iso.nominal_contact_stress(
                mesh, nominal, duty.gears.flanks.equivalent_modulus
            ),
            tangential_force=nominal,
            gears=self._gears(name, own, duty, nominal, factors, limits),
            flanks=self._flanks(duty, loads, scale, key, own),
        )

    def _stated(self, key: str, factor: str) -> float | None:
        """A load factor that the case states for this mesh or for all."""
        own = getattr(self.table.meshes.get(key), factor, None)
        return cast("float | None", own or getattr(self.table, factor))

    def _own(self, name: str, gear: Gear) -> GearStrength:
        return self.table.gears.get(joined_key(name, gear.name), GearStrength())

    def _factors(
        self,
        name: str,
        own: GearSet,
        duty: MeshDuty,
        loads: LineLoads,
        elastic: LoadedMesh,
        nominal: float,
        sharing: float,
        limits: list[Material],
    ) -> LoadFactors:
        table, gears = self.table, duty.gears
        mesh, key = gears.mesh, joined_key(name, gears.key)
        width = mesh.face_width
        tables = self.case.gearings[name].tables
        deviations = [
            flank_tolerances(
                tables[gear.name].accuracy_class or table.accuracy_class,
                gear.rack.normal_module,
                2 * gear.reference_radius,
                gear.face_width,
            )
            for gear in mesh.gears
        ]
        cosine = math.cos(mesh.gear1.rack.transverse_pressure_angle)
        base = max(it.single_pitch for it in deviations) * cosine
        form = max(it.profile_form for it in deviations)
        worn, worn_form = (
            min(iso.running_in(it.treatment, it.contact, deviation) for it in limits)
            for deviation in (base, form)
        )
        reliefs = [
            0.0 if it.tip_relief is None else it.tip_relief.amount
            for it in (gears.deviations.member1, gears.deviations.member2)
        ]
        moved = iso.Excitation(
            stiffness=MATERIAL_STIFFNESS * float(elastic.tangent_stiffness.mean()) / width,
            contact_ratio=mesh.transverse_contact_ratio,
            total_contact_ratio=mesh.transverse_contact_ratio + mesh.overlap_ratio,
            pitch_deviation=max(base, form) - worn,
            form_deviation=form - worn_form,
            tip_relief=min(reliefs) or iso.running_in_relief(it.contact for it in limits),
        )
        load = table.application_factor * sharing * nominal / width
        dynamic = self._stated(key, "dynamic_factor")
        if dynamic is None:
            resonance = self._resonance(name, own, duty, moved.stiffness)
            dynamic = moved.dynamic_factor(load, resonance)
        computed = face_load_factor(loads, mesh)
        face = self._stated(key, "face_load_factor") or computed
        depth = max(abs(it.tip_radius - it.root_radius) for it in mesh.gears)
        stated = self._stated(key, "transverse_load_factor")
        pressed, bent = (
            (stated, stated)
            if stated
            else moved.transverse_shares(load * dynamic * face, iso.contact_ratio_factor(mesh))
        )
        return LoadFactors(
            application=table.application_factor,
            sharing=sharing,
            dynamic=dynamic,
            face=face,
            face_computed=computed,
            transverse=pressed,
            transverse_bending=bent,
            face_bending=iso.face_factor_bending(face, width, depth),
        )

    def _resonance(self, name: str, own: GearSet, duty: MeshDuty, stiffness: float) -> float:
        """N: speed over that of the resonance. ISO 6336-1, Eq. 6; a held gear does not move."""
        mesh, bodies = duty.gears.mesh, duty.gears.bodies
        tables, compliance = self.case.gearings[name].tables, 0.0
        for gear, body in zip(mesh.gears, bodies, strict=True):
            _, inertia = gear_body(gear, tables[gear.name])
            if abs(self.state.speeds[body]) > 0:
                mates = self._mates(own, gear)
                compliance += mates * gear.base_radius**2 * gear.face_width / inertia
        if compliance == 0:
            return 0.0
        natural = math.sqrt(stiffness * compliance) / mesh.gear1.teeth
        return abs(duty.speed1) / natural

    def _mates(self, own: GearSet, gear: Gear) -> int:
        """How many gears are in mesh with one flank of it."""
        planets = {planet.body for planet in own.planets}
        for mesh in own.meshes:
            for one, body in zip(mesh.mesh.gears, mesh.bodies, strict=True):
                if one.name == gear.name:
                    return 1 if body in planets or not planets else own.count
        return 1

    def _gears(
        self,
        name: str,
        own: GearSet,
        duty: MeshDuty,
        nominal: float,
        factors: LoadFactors,
        limits: list[Material],
    ) -> tuple[GearRating, GearRating]:
        mesh = duty.gears.mesh
        speeds = abs(duty.speed1), abs(duty.speed1) / mesh.ratio
        roughness = (duty.gears.flanks.roughness1, duty.gears.flanks.roughness2)
        heights = [
            self._own(name, gear).flank_height or RZ_OVER_RA * RA_OVER_RQ * rough
            for gear, rough in zip(mesh.gears, roughness, strict=True)
        ]
        radius = mesh.equivalent_radius(mesh.pitch_point)  # rho_red, transverse
        radius *= math.cos(mesh.gear1.rack.base_helix_angle)
        viscosity = oil_state(self.oil, 40 + lubricated.ZERO_CELSIUS).kinematic_viscosity
        speed = speeds[0] * mesh.gear1.reference_radius
        modulus = duty.gears.flanks.equivalent_modulus
        stress = iso.nominal_contact_stress(mesh, nominal, modulus) * math.sqrt(factors.contact)
        single = iso.single_contact_factors(mesh)
        made = []
        for member, gear in enumerate(mesh.gears):
            material, table = limits[member], self._own(name, gear)
            cycles = self.table.life * speeds[member] * self._mates(own, gear) / (2 * math.pi)
            root = iso.tooth_root(gear, duty.gears.tools[member], mesh.transverse_contact_ratio)
            bent = iso.nominal_root_stress(mesh, root, nominal, gear.face_width)
            loads = sum(gear.name in (it.mesh.gear1.name, it.mesh.gear2.name) for it in own.meshes)
            mean = table.mean_stress_factor or (0.7 if loads > 1 else 1.0)
            made.append(
                GearRating(
                    gear=joined_key(name, gear.name),
                    cycles=cycles,
                    material=material.name,
                    contact_stress=stress * single[member],
                    contact_limit=contact_limit(
                        limits, member, cycles, heights, radius, viscosity, speed
                    ),
                    form_factor=root.form_factor,
                    stress_correction=root.stress_correction,
                    nominal_root_stress=bent,
                    root_stress=bent * factors.bending,
                    root_limit=root_limit(material, root, cycles, table.root_height, mean),
                )
            )
        return made[0], made[1]

    def _flanks(
        self, duty: MeshDuty, loads: LineLoads, scale: float, key: str, own: GearSet
    ) -> FlankRating:
        """From the fields of the mesh, its load raised by `scale`."""
        if duty.speed1 == 0:
            return FlankRating(**dict.fromkeys(FlankRating.__dataclass_fields__, math.nan))
        fluids = self.state.fluids
        raised = replace(loads, line_load=loads.line_load * scale)
        stronger = replace(duty, torque1=duty.torque1 * scale)
        contact = contact_under(stronger, raised, fluids.at(key), fluids.oil)
        friction_model = duty.gears.models.friction.solved_for(contact)
        friction = np.asarray(friction_model.coefficient(contact.seen_by(friction_model)))
        flash = flash_temperatures(contact, friction, duty.gears.materials)
        mesh, oil = duty.gears.mesh, fluids.oil
        lubrication = LUBRICATION_FACTORS[self.case.thermal.lubrication]
        mates = max(self._mates(own, gear) for gear in mesh.gears)
        power = contact.line_load * np.abs(contact.sliding_speed)
        warm = self.case.models.temperatures != "inlet"
        loss = float((friction * power) @ contact.weight)
        bulk = contact.oil.temperature
        if not warm:
            rise = bulk_rise_of_loss(loss, mesh.center_distance, mesh.face_width, lubrication)
            bulk = oil.temperature + rise
        along = path_means(contact, flash)
        scuffed = bulk if warm else oil.temperature + bulk_rise_of_flash(along, lubrication, mates)
        temperatures, place = np.unique(np.round(bulk + flash), return_inverse=True)
        viscosity, alpha = lubricated.film_oil(self.oil, temperatures)
        film = lubricated.film_thickness(
            contact.radius,
            2 * contact.rolling_speed,
            contact.hertz_pressure,
            duty.gears.flanks.equivalent_modulus,
            lubricated.film_oil(self.oil, bulk),
            (viscosity[place], alpha[place]),
        )
        roughness = RA_OVER_RQ * (contact.flanks.roughness1 + contact.flanks.roughness2) / 2
        thinnest = int(np.argmin(film))
        stage, micro = self.stages
        limit = lubricated.reference_film(self.oil, micro).permissible
        viscosity40 = oil_state(self.oil, 40 + lubricated.ZERO_CELSIUS).kinematic_viscosity
        factor = self.oil.lubricant_factor.value
        scuffing = lubricated.scuffing_temperature(stage, oil.dynamic_viscosity, factor)
        rise = lubrication * mates_factor(mates)
        warmed = bulk if warm else lubricated.integral_bulk(oil.temperature, along, rise)
        integral = lubricated.integral_temperature(warmed, along)
        most = lubricated.integral_scuffing_temperature(stage, viscosity40, factor)
        hottest = scuffed + float(flash.max())
        ratio = float(film[thinnest]) / roughness
        return FlankRating(
            bulk_temperature=bulk,
            film_ratio=ratio,
            film_ratio_limit=limit,
            micropitting_place=float(contact.path[thinnest]),
            contact_temperature=hottest,
            scuffing_temperature=scuffing,
            integral_temperature=integral,
            integral_scuffing_temperature=most,
            micropitting=ratio / limit,
            scuffing=lubricated.flash_safety(scuffing, hottest, oil.temperature),
            integral_scuffing=lubricated.integral_safety(most, integral),
        )

    def planet_bearings(self, name: str, own: GearSet) -> Iterator[BearingRating]:
        """The roller bearings of the planets of a set, under the K_gamma of its meshes."""
        state = self.state
        carrier = state.speeds[own.carrier]
        duties = {duty.gears.key: duty for duty in own.loaded_duties(state)}
        for key, torque in ((duty.gears.key, duty.torque1) for duty in own.mean_duties(state)):
            if stated := self._stated(joined_key(name, key), "mesh_load_factor"):
                duties[key] = replace(duties[key], torque1=stated * torque)
        for planet in own.planets:
            bearing = planet.bearing
            if isinstance(bearing, PlanetBearing):
                load = replace(planet, tilts=False).load(duties, carrier)[1].force
                speed = state.speeds[planet.body] - carrier
                known = rated(bearing.bearing, bearing.aligns_itself, bearing.cage)
                yield from self._bearing(joined_key(name, planet.key), known, load, speed)

    def shaft_bearings(self, shafts: Iterable[ShaftBearing]) -> Iterator[BearingRating]:
        """The rolling bearings of shafts."""
        state = self.state
        for one in shafts:
            load = dynamic_load(one.bearing, one.force or state.forces[one.key])
            speed = state.speeds[one.between[0]] - state.speeds[one.between[1]]
            yield from self._bearing(one.key, one.bearing, load, speed)

    def _bearing(
        self, key: str, bearing: CatalogueBearing, load: float, speed: float
    ) -> Iterator[BearingRating]:
        fluids, table = self.state.fluids, self.table
        if load and speed and not math.isnan(bearing.dynamic_load_rating):
            load *= table.application_factor
            viscosity = fluids.at(key).kinematic_viscosity
            yield bearing_rating(
                key, bearing, load, abs(speed), viscosity, table.contamination_factor
            )


def path_means(contact: MeshContact, values: FloatArray) -> float:
    """Mean along the path of contact of the mean across it: theta_flm of ISO/TS 6336-20."""
    edges = np.linspace(contact.path.min(), contact.path.max() * (1 + 1e-9) + 1e-12, 21)
    weight, _ = np.histogram(contact.path, edges, weights=contact.weight)
    total, _ = np.histogram(contact.path, edges, weights=contact.weight * values)
    return float((total[weight > 0] / weight[weight > 0]).mean())


def contact_limit(
    limits: list[Material],
    member: int,
    cycles: float,
    heights: list[float],  # Rz of both flanks. [m]
    radius: float,  # rho_red at the pitch point, transverse. [m]
    viscosity40: float,  # [m^2/s]
    speed: float,  # At the reference circle. [m/s]
) -> float:
    """sigma_HG of a gear. ISO 6336-2, Eq. 6. [Pa]"""
    own, mate = limits[member], limits[1 - member]
    softer = min(it.contact for it in limits)
    factor = iso.oil_factor(softer, viscosity40) * iso.speed_factor(softer, speed)
    factor *= iso.roughness_factor(softer, sum(heights) / 2, radius)
    if own.treatment == "through-hardened" and mate.treatment != "through-hardened":
        hard = heights[1 - member]
        height = hard * math.pow(10e-3 / radius, 0.33)
        height *= math.pow(heights[1 - member] / heights[member], 0.66)
        height /= math.pow(max(viscosity40 * 1e6 * speed / 1500, 1e-6), 0.33)
        factor *= iso.hardening_factor(own.hardness / 1.05, height)
    lives = float(iso.life_factor(cycles, iso.PITTING_LIFE[own.treatment]))
    return own.contact * factor * lives


def root_limit(
    material: Material, root: iso.ToothRoot, cycles: float, height: float, mean: float
) -> float:
    """sigma_FG of a root with R_z `height` [m] and Y_M `mean`. ISO 6336-3, Eq. 5. [Pa]"""
    factor = 2.0 * mean * float(iso.life_factor(cycles, iso.BENDING_LIFE[material.treatment]))
    factor *= iso.notch_sensitivity(root, material.slip_layer)
    factor *= iso.root_surface_factor(material.treatment, height)
    return material.bending * factor * iso.size_factor_bending(material.treatment, root.module)


JSON_UNITS = {
    "stress": ("MPa", 1e6, 0.0), "contact_limit": ("MPa", 1e6, 0.0),
    "root_limit": ("MPa", 1e6, 0.0), "temperature": ("degC", 1.0, lubricated.ZERO_CELSIUS),
    "place": ("mm", 1 / iso.MM, 0.0), "load": ("N", 1.0, 0.0), "load_rating": ("N", 1.0, 0.0),
    "speed": ("rpm", math.pi / 30, 0.0), "life": ("h", 3600.0, 0.0),
}  # fmt: skip
"""Unit, factor and zero of what JSON holds, by the ends of names."""


def as_dict(found: Strength) -> dict[str, Any]:
    """The strength as JSON holds it, with units in the keys."""
    return {
        "after": AFTER,
        "least": found.least(),
        "oil_stages": {
            "scuffing": found.stages[0],
            "micropitting": found.stages[1],
            "source": found.stages_source,
        },
        "meshes": {
            mesh.key: {
                "load_factors": _in_units(mesh.factors),
                "tangential_force_N": mesh.tangential_force,
                "nominal_contact_stress_MPa": mesh.nominal_contact_stress / 1e6,
                "gears": {it.gear: _in_units(it, "pitting", "bending") for it in mesh.gears},
                "flanks": _in_units(mesh.flanks),
            }
            for mesh in found.meshes
        },
        "bearings": {one.key: _in_units(one) for one in found.bearings},
        "notes": list(found.notes),
    }


def _in_units(one: Any, *more: str) -> dict[str, Any]:
    """Numbers of a rating, with units in the keys; NaN is none."""
    found: dict[str, Any] = {}
    for name in (*more, *(it for it in one.__dataclass_fields__ if it not in ("gear", "key"))):
        value = getattr(one, name)
        known = next((it for end, it in JSON_UNITS.items() if name.endswith(end)), None)
        if known is not None:
            name, value = f"{name}_{known[0]}", (value - known[2]) / known[1]
        found[name] = None if value != value else value
    return found
