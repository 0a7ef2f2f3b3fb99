"""Rolling losses by formula, and friction and rolling from the fitted models of an oil."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property, lru_cache
from typing import Any, ClassVar, Generic, Protocol, TypeVar

import numpy as np

from epicyclic.arrays import TINY, BoolArray, FloatArray, Points, row_by_row, taken
from epicyclic.contact.fitted_models import OilModel, at_each, rolling_scale
from epicyclic.contact.line_contact import CONDITIONS, Flanks, LineContacts
from epicyclic.dataclass import dataclass, replace
from epicyclic.gears.mesh import Mesh
from epicyclic.kernels.interpolation import along_path, over_pressure
from epicyclic.kernels.line_contact import goksem_hargreaves_losses, line_load_at_pressure
from epicyclic.kernels.mixed_ehl import rolling_loss_number_at
from epicyclic.losses.contact import MeshContact
from epicyclic.losses.friction import (
    FRICTION_MODELS,
    REGRESSION_SOURCE,
    TALBOT_FLUID,
    TALBOT_GEAR_RANGES,
    FrictionModel,
    NothingToSolve,
    beyond_data,
    equally_rough,
    held_in_table,
    pairing_ratio,
)
from epicyclic.losses.ranges import (
    Formula,
    LossModel,
    ModelUse,
    Range,
    RangeFlags,
    RegressionFluid,
    ValidityFlag,
    check_contacts,
)
from epicyclic.oil.oil import OilState
from epicyclic.units import (
    GIGAPASCAL,
    METRE_PER_SECOND,
    MICROMETRE,
    MILLIMETRE,
    MILLIPASCAL_SECOND,
    NUMBER,
    PER_GIGAPASCAL,
    Quantity,
)

# Rolling loss per contact length of a mesh: a new model is a function with an entry below.


class RollingModel(LossModel, Protocol):
    """A way to the rolling loss per contact length."""

    def loss_density(self, contact: MeshContact) -> FloatArray:
        """Rolling loss per contact length at each point, shape (n,). [W/m]"""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class RollingFormula(Formula):
    """A formula for the rolling loss."""

    # From the contacts, and whether conditions of the oil are held where a regression was made.
    function: Callable[[Any, bool], FloatArray]
    oil_held: bool = True

    def loss_density(self, contact: LineContacts) -> FloatArray:
        """Rolling loss per contact length at each point, shape (n,). [W/m]"""
        return self.function(contact, self.oil_held)


def mixed_ehl_rolling(contact: LineContacts, oil_held: bool) -> FloatArray:
    """Regression of 33,600 mixed-EHL simulations of an automatic transmission fluid. [W/m]

    Theory (R5). Talbot (2012), Eq. 5.10 and Table 5.2(b), in the scale of `rolling_scale`.
    """
    held = held_in_table(contact, oil_held=oil_held)
    number = at_each(rolling_loss_number_at, held)
    return number * rolling_scale(held) * _beyond(contact, held)


def _beyond(contact: LineContacts, held: LineContacts) -> FloatArray:
    return beyond_data(contact.line_load, held.line_load, contact.rolling_speed, held.rolling_speed)


def paired_rolling(contact: LineContacts, oil_held: bool) -> FloatArray:
    """`mixed_ehl_rolling` of two flanks as rough as the rougher one, times the effect of the other.

    Theory (O13).
    """
    published = mixed_ehl_rolling(equally_rough(contact), oil_held)
    return published * pairing_ratio("rolling_loss", contact)


def goksem_hargreaves(contact: MeshContact, oil_held: bool) -> FloatArray:
    """Rolling force of both surfaces of a smooth, fully flooded contact, times u_r. [W/m]

    Theory (R7), (R10). The formula belongs to elastic contacts, and its force does not vanish with
    the load. That of rigid cylinders and an oil of constant viscosity does; where it is smaller, it
    takes over.
    """
    oil, modulus = contact.oil, contact.flanks.equivalent_modulus
    numbers = modulus, oil.dynamic_viscosity, oil.pressure_viscosity, oil.thermal_load(1.0)
    places = contact.line_load, contact.radius, contact.rolling_speed
    return row_by_row(goksem_hargreaves_losses, places, numbers)


CONTAINED = RollingFormula(
    name="contained",
    title="rolling loss contained in the friction",
    source="the tests of the friction model",
    reliability="that of the friction, which was fitted to the whole load-dependent loss",
    function=lambda contact, oil_held: np.zeros_like(contact.line_load),
)
"""What `auto` is with friction in `CONTAINS_ROLLING`; no case asks for it by name. Theory (R11)."""

ROLLING_MODELS = {
    model.name: model
    for model in (
        RollingFormula(
            name="mixed-ehl",
            title="mixed-EHL rolling-loss regression",
            source=f"{REGRESSION_SOURCE}, Eq. 5.10",
            reliability="its scale is a reconstruction, correct within a factor of about 2 "
            "against smooth contacts (R4)",
            function=mixed_ehl_rolling,
            ranges=TALBOT_GEAR_RANGES,
            made_for=TALBOT_FLUID,
        ),
        RollingFormula(
            name="mixed-ehl+pairing",
            several=False,
            title="mixed-EHL rolling-loss regression, pairing of unequal flanks from the solver",
            source=f"{REGRESSION_SOURCE}, Eq. 5.10; solver for line contacts of this package",
            reliability="mixed-ehl where both flanks are equally rough; the effect of a smoother "
            "flank is from the solver of this package",
            function=paired_rolling,
            ranges=TALBOT_GEAR_RANGES,
            made_for=TALBOT_FLUID,
        ),
        RollingFormula(
            name="goksem-hargreaves",
            title="rolling loss of Goksem and Hargreaves",
            source="Goksem and Hargreaves, J. Lubr. Technol. 100 (1978) 346; light load: "
            "H. M. Martin, Engineering 102 (1916) 119",
            reliability="within about 15 % of solved smooth contacts without heating; rough "
            "contacts lose more",
            function=goksem_hargreaves,
            ranges=(
                Range(
                    "moes_load",
                    "load parameter M of Moes",
                    3.0,
                    200.0,
                    NUMBER,
                    "numerical solutions of the smooth line contact",
                ),
                Range(
                    "film_ratio", "film ratio", 1.0, None, NUMBER, "the formula is for full films"
                ),
            ),
        ),
    )
}


# Fitted quantities of one mesh or bearing at one speed, as tables.
#
# With one oil and one pair of surfaces, radius, speeds and slip of a contact of flanks follow from
# its place on the path of contact, those of a roller from its race. What is left is the pressure,
# which changes from pass to pass and from one operating point to the next: a fit is evaluated once
# for all of them.


POINTS, PRESSURES = 48, 32
"""Points on each side of the pitch point, and of the pressure: losses are off by some 1e-5."""
RACE_PRESSURES = 64  # Points of the pressure at the race of a bearing.
LEAST_SLIP = 0.01
"""Slip at which points stop to crowd: fits change with the slip over its logarithm above. [1]"""
NO_SLIP = 1e-300  # Sliding speed at the pitch point, of which only the sign counts. [m/s]


@dataclass(frozen=True, slots=True)
class _Motion:
    """How the flanks of a mesh move at places on its path. Attributes as of `MeshContact`."""

    mesh: Mesh
    speed1: float
    speed2: float

    def speeds(self, path: FloatArray) -> tuple[FloatArray, FloatArray]:
        """u_r and u_s. [m/s]"""
        curvature1 = self.mesh.pitch_point + path
        one, two = self.speed1 * curvature1, self.speed2 * self.mesh.curvature2(curvature1)
        return (one + two) / 2, one - two

    def radius(self, path: FloatArray) -> FloatArray:
        """Equivalent radius. [m]"""
        return self.mesh.equivalent_radius(self.mesh.pitch_point + path)


@dataclass(frozen=True, eq=False)
class RaceContacts(LineContacts):
    """Rollers on the races of a bearing: under the same loads on each of them, without slip."""

    oil: OilState
    races: tuple[float, ...]  # Equivalent radius at each. [m]
    speed: float  # Rolling speed. [m/s]

    @property
    def loaded(self) -> BoolArray:
        """Which of them carry load at each of several points."""
        return self.line_load > 0


def tabulated(
    model: OilModel,
    quantity: str,  # As for its `value`.
    form: str,  # As for its `value`.
    contacts: MeshContact | RaceContacts,  # n of them.
) -> FloatArray:
    """`OilModel.value` at every contact of a mesh or bearing, interpolated. Theory (O16)."""
    pressure = np.clip(contacts.hertz_pressure, *model.fits[quantity].domain["hertz_pressure"])
    fit = model, quantity, form
    if isinstance(contacts, MeshContact):
        motion = _Motion(contacts.mesh, contacts.speed1, contacts.speed2)
        return along_path(
            contacts.path, pressure, *_path_table(*fit, motion, contacts.flanks, contacts.oil)
        )
    alike = contacts.races, contacts.speed, contacts.flanks, contacts.oil
    each = taken(alike, range(len(pressure))) if isinstance(pressure, Points) else [alike]
    found = np.empty_like(pressure)
    shape = len(each), len(contacts.races), -1
    pressures, places = (np.asarray(it).reshape(shape) for it in (pressure, found))
    for (races, *own), given, into in zip(each, pressures, places, strict=True):
        for race, of_race, place in zip(races, given, into, strict=True):
            place[:] = over_pressure(of_race, *_race_table(*fit, race, *own))
    return found


@lru_cache(maxsize=1024)  # two for each set and speed of a map
def _race_table(
    model: OilModel,
    quantity: str,
    form: str,
    radius: float,
    speed: float,
    flanks: Flanks[float],
    oil: OilState,
) -> tuple[FloatArray, FloatArray]:
    """Arguments of `over_pressure`: lowest and highest pressure, and what lies between them."""
    pressures = np.geomspace(*model.fits[quantity].domain["hertz_pressure"], RACE_PRESSURES)
    radii = np.full_like(pressures, radius)
    contacts = LineContacts(
        line_load=line_load_at_pressure(pressures, radii, flanks.equivalent_modulus),
        radius=radii,
        rolling_speed=np.full_like(pressures, speed),
        sliding_speed=np.zeros_like(pressures),
        flanks=flanks,
        oil=oil,
    )
    return pressures[[0, -1]], model.value(quantity, contacts, form)


@lru_cache(maxsize=64)
def _path_table(
    model: OilModel, quantity: str, form: str, motion: _Motion, flanks: Flanks[float], oil: OilState
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Arguments of `along_path`: ends, crowding, lowest and highest pressure, values."""
    path = np.array([motion.mesh.path_start, motion.mesh.path_end]) - motion.mesh.pitch_point
    ends = np.array([min(path[0], 0.0), max(path[1], 0.0)])
    rolling, sliding = motion.speeds(ends)
    slip = np.abs(sliding) / rolling
    crowding = np.log1p(np.maximum(slip, LEAST_SLIP) / LEAST_SLIP)
    places = ends * np.expm1(np.linspace(0.0, crowding, POINTS)) / np.expm1(crowding)
    # nothing slides at the pitch point, but each side has its sign there too
    sliding = motion.speeds(places)[1] + NO_SLIP * np.sign(sliding)
    pressures = np.geomspace(*model.fits[quantity].domain["hertz_pressure"], PRESSURES)
    place, pressure = (grid.ravel() for grid in np.meshgrid(places.T, pressures, indexing="ij"))
    radius = motion.radius(place)
    contacts = LineContacts(
        line_load=line_load_at_pressure(pressure, radius, flanks.equivalent_modulus),
        radius=radius,
        rolling_speed=motion.speeds(place)[0],
        sliding_speed=np.repeat(sliding.T, PRESSURES),
        flanks=flanks,
        oil=oil,
    )
    values = model.value(quantity, contacts, form).reshape(2, POINTS, PRESSURES)
    return ends, crowding, pressures[[0, -1]], values


# Friction and rolling loss of an oil that was characterised: fits to its simulated contacts.

_LABELS: dict[str, tuple[str, Quantity]] = {
    "slide_to_roll_ratio": ("slide-to-roll ratio", NUMBER),
    "rolling_speed": ("rolling speed", METRE_PER_SECOND),
    "radius": ("equivalent radius", MILLIMETRE),
    "hertz_pressure": ("Hertz pressure", GIGAPASCAL),
    "roughness1": ("rms roughness of surface 1", MICROMETRE),
    "roughness2": ("rms roughness of surface 2", MICROMETRE),
    "dynamic_viscosity": ("dynamic viscosity", MILLIPASCAL_SECOND),
    "pressure_viscosity": ("pressure-viscosity coefficient", PER_GIGAPASCAL),
}
"""Label and unit of each condition that spans a domain."""


@dataclass(frozen=True)
class _Fit(RangeFlags):
    """What friction and rolling loss share that are fitted to the simulated contacts of one oil."""

    name: ClassVar = "fitted"
    title: ClassVar = "fit to simulated contacts of the oil"
    made_for: ClassVar[RegressionFluid | None] = None

    model: OilModel
    form: str
    quantity: str  # Which of the fits of the model.

    @property
    def source(self) -> str:
        """What was simulated."""
        simulated = self.model.simulations.get("simulated", 0)
        title, version = self.model.oil.title, self.model.version
        return f"{simulated} contacts of {title} simulated with epicyclic {version}"

    @cached_property
    def ranges(self) -> tuple[Range, ...]:
        """The domain of the fit."""
        return domain_ranges(self.model, self.quantity)

    def fitted(self, contact: LineContacts) -> FloatArray:
        """The quantity at every contact."""
        if isinstance(contact, MeshContact | RaceContacts):
            return tabulated(self.model, self.quantity, self.form, contact)
        return self.model.value(self.quantity, contact, self.form)


@dataclass(frozen=True)
class FittedFriction(NothingToSolve, _Fit):
    """Coefficients fitted to the simulated contacts of one oil. Theory (O9)."""

    takes_oil_temperature: ClassVar[bool] = False

    quantity: str = "friction"

    def coefficient(self, contact: LineContacts) -> FloatArray:
        """See the class. [1]"""
        return self.fitted(contact)


@dataclass(frozen=True)
class FittedRolling(_Fit):
    """Rolling loss fitted to the simulated contacts of one oil. Theory (O9).

    Beyond the loads and speeds of the simulations the loss goes on as that of the regressions,
    Theory (R5).
    """

    # ``"rolling_loss"`` of gear teeth or ``"bearing_rolling_loss"``.
    quantity: str = "rolling_loss"

    def loss_density(self, contact: LineContacts) -> FloatArray:
        """See the class. [W/m]"""
        held = contact.held(self.model.fits[self.quantity].domain)
        return self.fitted(contact) * _beyond(contact, held)


def domain_ranges(model: OilModel, quantity: str) -> tuple[Range, ...]:
    """The domain of a fit."""
    source = f"the simulations of {model.oil.name}"
    ranges = []
    for name, (label, unit) in _LABELS.items():
        limits = model.fits[quantity].domain[name]
        shown = (unit.to_display(value) if unit.si else value for value in limits)
        low, high = (float(f"{value:.4g}") for value in shown)
        ranges.append(Range(name, label, low, high, unit, source))
    return tuple(ranges)


# Fitted models where their contacts were simulated, a general formula beyond: what `auto` takes.
#
# Beyond the simulations the weight of the fit falls smoothly, so that losses over speed, load or
# temperature have no step.

Fit = TypeVar("Fit", FittedFriction, FittedRolling)

REACH = 1.5  # Factor beyond a limit of the simulations at which a fit has no weight left. [1]
MODULUS_SLACK = 1.1
"""Factor by which the equivalent modulus may differ from the simulated one: that of steels does
not, that of other materials does. [1]"""


NO_LEAST = "slide_to_roll_ratio"
"""The condition without a lower limit: where little slides, little is lost, and fits go on."""


def weight_of_fit(
    model: OilModel,
    quantity: str,  # A key of its fits.
    contacts: LineContacts,  # n of them.
) -> FloatArray:
    """Weight of a fit at each contact: 1 in its simulations, 0 far beyond. Theory (O11). [1]"""
    domain = model.fits[quantity].domain
    modulus = contacts.flanks.equivalent_modulus / model.equivalent_modulus
    beyond: float | FloatArray = max(1.0, modulus, 1 / modulus) / MODULUS_SLACK
    for name in CONDITIONS:  # numbers first take less time than arrays of one number each
        value = getattr(contacts, name)
        low, high = domain[name]
        if high > 0:
            beyond = np.maximum(beyond, value / high)
        if low > 0 and name != NO_LEAST:
            beyond = np.maximum(beyond, low / np.maximum(value, TINY))
    t = np.clip(np.log(beyond) / math.log(REACH), 0.0, 1.0)
    return 1 - t * t * (3 - 2 * t)


@dataclass(frozen=True, slots=True)
class _FittedOrFormula(Generic[Fit]):
    """A fit to the contacts of an oil, and a formula beyond them. Theory (O11)."""

    name: ClassVar[str]
    made_for: ClassVar[RegressionFluid | None] = None
    beyond: ClassVar[FrictionModel | RollingModel]

    fitted: Fit

    @property
    def title(self) -> str:
        """Both methods."""
        return f"{self.fitted.title}; outside their range {self.beyond.title}"

    @property
    def source(self) -> str:
        """Source of both."""
        return f"{self.fitted.source}; {self.beyond.source}"

    @property
    def ranges(self) -> tuple[Range, ...]:
        """Where the fit holds."""
        return tuple(
            replace(item, low=None) if item.name == NO_LEAST else item
            for item in self.fitted.ranges
        )

    def weight(self, contact: LineContacts) -> FloatArray:
        """Weight of the fit at each contact. [1]"""
        return weight_of_fit(self.fitted.model, self.fitted.quantity, contact)

    def flags(self, role: str, contact: MeshContact, loss: FloatArray) -> tuple[ValidityFlag, ...]:
        """What leaves the range of the fit, and that of the formula where the formula is used."""
        where = contact.mesh.name
        fit = ModelUse(role, self.name, where, instead=self.beyond.name)
        outside = check_contacts(fit, self.ranges, contact, loss)
        rest: FloatArray = (1 - self.weight(contact)) * loss
        if not rest.any():
            return outside
        formula = ModelUse(role, self.beyond.name, where)
        part = float(rest.sum() / loss.sum())
        return outside + check_contacts(formula, self.beyond.ranges, contact, rest, part)


@dataclass(frozen=True, slots=True)
class FittedOrSchlenk(NothingToSolve, _FittedOrFormula[FittedFriction]):
    """The fit to contacts of an oil, and the mean friction of Schlenk beyond. Theory (O11)."""

    name: ClassVar = "fitted-or-schlenk"
    takes_oil_temperature: ClassVar[bool] = False
    beyond: ClassVar[FrictionModel] = FRICTION_MODELS["schlenk"]

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        weight, fitted = self.weight(contact), self.fitted.coefficient(contact)
        if (weight == 1).all():
            return fitted
        formula = self.beyond.coefficient(contact.seen_by(self.beyond))
        return weight * fitted + (1 - weight) * formula


@dataclass(frozen=True, slots=True)
class FittedOrGoksem(_FittedOrFormula[FittedRolling]):
    """The fit to contacts of an oil, and the loss of Goksem and Hargreaves beyond. Theory (O11)."""

    name: ClassVar = "fitted-or-goksem-hargreaves"
    beyond: ClassVar[RollingModel] = ROLLING_MODELS["goksem-hargreaves"]

    def loss_density(self, contact: MeshContact) -> FloatArray:
        """See the class. [W/m]"""
        weight, fitted = self.weight(contact), self.fitted.loss_density(contact)
        if (weight == 1).all():
            return fitted
        return weight * fitted + (1 - weight) * self.beyond.loss_density(contact)
