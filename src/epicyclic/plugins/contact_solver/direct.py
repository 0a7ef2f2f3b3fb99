"""Friction of a mesh from its own line contacts, solved one by one.

The contacts of a mesh differ in two quantities only: position on the path of contact, which sets
curvature, speeds and slip, and load. So a few dozen solved contacts, spread over what occurs, are
enough; between them the ratio of the friction to a closed form is interpolated, and others, which
are drawn by the sliding power and take no part, tell the error. Theory (O10).
"""

from __future__ import annotations

from functools import lru_cache
from typing import ClassVar

import numpy as np

from epicyclic.arrays import FloatArray, IntArray
from epicyclic.build.models import SetCase, solid_of
from epicyclic.case.tables.models import oil_laws
from epicyclic.contact.elastic_teeth import one_thread
from epicyclic.contact.fitted_models import EYRING_STRESS, eyring_friction
from epicyclic.dataclass import dataclass, replace
from epicyclic.errors import ConvergenceError, Status
from epicyclic.losses.contact import MeshContact
from epicyclic.losses.friction import CONTACT_PROGRESS
from epicyclic.losses.ranges import SMALLEST_SHOWN_SHARE, Range, RangeFlags, RegressionFluid
from epicyclic.oil.rheology import PRESETS, OilLaws
from epicyclic.plugins.contact_solver.conditions import (
    DRY_SPEED,
    FEWEST_KEPT,
    SOLVER_BOX,
    VALIDATED_FILM_RATIO,
    Heating,
    LineContact,
    contact_oil,
    heating_of,
    line_contact,
)
from epicyclic.plugins.contact_solver.rough import (
    BRIEF,
    LARGEST_UNSOLVED_SHARE,
    AsperityContact,
    solve_rough,
)
from epicyclic.plugins.contact_solver.steady import solve_smooth
from epicyclic.plugins.contact_solver.surfaces import PERIOD, generate_profile
from epicyclic.units import GIGAPASCAL, METRE_PER_SECOND, MILLIMETRE, NUMBER, Quantity, percent

BATCH = 12  # Contacts solved before the error is looked at, and each time it is too large.
CHECKS = 8  # Contacts that only tell the error.
SMALLEST_SLIP = 0.05
"""Slide-to-roll ratio below which contacts are interpolated only: they cost no power, and their
small friction is long not stationary. [1]"""
SMOOTH_FILM_RATIO = 10.0  # Film ratio from which on a whole mesh is solved as smooth. [1]
LARGEST_ERROR = 0.10  # Standard error of a friction over it above which a contact is left out. [1]
LARGEST_LEFT_OUT = 0.25  # Share of contacts left out above which there is no result. [1]
ALIKE = 1e-9
"""Range of the logarithm of the line load, and of the path in metres, that is rounding."""
PLACES = 9  # Decimals of a place, of which the whole mesh has -1 to 1, that are not rounding.
NEARLY = 0.1  # Change of the force of a mesh up to which its solved contacts are used again. [1]
SMOOTHING = 1e-2
"""Smoothing of the interpolation: about the scatter of solved contacts, 2 %, squared over their
variance."""


def solver_range(name: str, label: str, unit: Quantity) -> Range:
    """Where the solver of line contacts is tested."""
    scale, _ = unit.scale_and_offset()
    low, high = SOLVER_BOX[name]
    return Range(name, label, low * scale, high * scale, unit, "tests of the solver")


@dataclass(frozen=True, slots=True)
class DirectSettings:
    """Numbers that the solver takes from the case."""

    laws: OilLaws  # How the oil behaves under pressure and shear.
    asperities: AsperityContact  # Where surfaces touch.
    # Effusivity of the gears; None for isothermal contacts. [W s^0.5/(m^2 K)]
    effusivity: float | None
    correlation_length: float  # Correlation length of both flanks. [m]
    seed: int
    error: float  # Wanted mean error at contacts that take no part. [1]
    most_contacts: int  # Solved for a mesh, those for the error not counted.


@dataclass(frozen=True, slots=True, eq=False)
class _Solved:
    """The contacts of a mesh that were solved, and what to know about them."""

    force: float  # Transverse force of the mesh. [N]
    place: FloatArray  # As from `_place`, each over -1 to 1 within `limits`.
    ratio: FloatArray  # Friction over the closed form. [1]
    limits: FloatArray  # Least and largest values of both over the whole mesh.
    remark: str

    def friction(self, contact: MeshContact) -> FloatArray:
        """Coefficient of friction at every point of the mesh under nearly that force. [1]"""
        place = _spread(_place(contact), self.limits)
        return _closed_form(contact) * _interpolated(self.place, self.ratio, place)


@dataclass(frozen=True, slots=True)
class EhlDirect(RangeFlags):
    """Line contacts of the mesh solved, and interpolated between them. Theory (O10)."""

    name: ClassVar = "ehl-direct"
    title: ClassVar = "line contacts of the mesh, solved"
    source: ClassVar = "solver for line contacts of this package"
    made_for: ClassVar[RegressionFluid | None] = None
    takes_oil_temperature: ClassVar[bool] = False
    ranges: ClassVar[tuple[Range, ...]] = (
        solver_range("radius", "equivalent radius", MILLIMETRE),
        solver_range("hertz_pressure", "Hertz pressure", GIGAPASCAL),
        solver_range("rolling_speed", "rolling speed", METRE_PER_SECOND),
        solver_range("slide_to_roll_ratio", "slide-to-roll ratio", NUMBER),
    )

    settings: DirectSettings
    solved: _Solved | None = None

    def solved_for(self, contact: MeshContact) -> EhlDirect:
        """With contacts that are solved: those it has, where they are of nearly that load.

        Between passes that bring torques and losses together the load changes by a few per cent,
        and the ratio to the closed form by far less than its error. Raises `ConvergenceError` if
        too many contacts have no solution.
        """
        if self.solved and abs(contact.force - self.solved.force) <= NEARLY * self.solved.force:
            return self
        return replace(self, solved=_solve_mesh(contact, self.settings))

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]; raises `ConvergenceError` if too many contacts have no solution."""
        return (self.solved or _solve_mesh(contact, self.settings)).friction(contact)

    @property
    def remarks(self) -> tuple[str, ...]:
        """How many contacts were solved, how many not, and the error."""
        return () if self.solved is None else (self.solved.remark,)


def friction_of(case: SetCase) -> EhlDirect:
    """The friction model of a case, with the numbers that the solver takes from it."""
    solver, boundary = case.contact_solver, case.models.boundary_friction
    touching = PRESETS[solver.preset]
    carried = None
    if solver.heating != "isothermal":
        given = solver.solid_conductivity, solver.solid_heat_capacity
        solids = [solid_of(gear.material, *given) for gear in case.gearing.tables.values()]
        carried = float(np.mean([solid.effusivity for solid in solids]))
    return EhlDirect(
        DirectSettings(
            laws=oil_laws(solver),
            asperities=AsperityContact(
                solver.asperity_film, touching.friction if boundary is None else boundary
            ),
            effusivity=carried,
            correlation_length=solver.correlation_length,
            seed=solver.seed,
            error=solver.error,
            most_contacts=solver.most_contacts,
        )
    )


def _closed_form(contact: MeshContact) -> FloatArray:
    """Friction between which and that of solved contacts the ratio is interpolated. [1]"""
    return eyring_friction(contact, EYRING_STRESS)


def _place(contact: MeshContact) -> FloatArray:
    """Position on the path of contact and logarithm of the line load, shape (n, 2)."""
    return np.stack([contact.path, np.log(contact.line_load)], axis=1)


def _solve_mesh(contact: MeshContact, settings: DirectSettings) -> _Solved:
    base = _closed_form(contact)
    own = _place(contact)
    limits = np.stack([own.min(axis=0), own.max(axis=0)])
    place = _spread(own, limits)
    power = contact.line_load * np.abs(contact.sliding_speed) * contact.weight
    _, first = np.unique(np.round(place, PLACES), axis=0, return_index=True)
    usable = np.sort(first)  # each place once
    sliding = usable[contact.slide_to_roll_ratio[usable] >= SMALLEST_SLIP]
    if sliding.size > BATCH + CHECKS:
        usable = sliding
    few = usable.size <= BATCH + CHECKS
    checks = usable[:0] if few else _quantiles(contact.path, power, usable)
    others = np.setdiff1d(usable, checks)
    order = others[_spread_out(place[others], others.size if few else settings.most_contacts)]
    known, kept = _ratios(contact, settings, checks, base, 0)
    trusted = known[np.isfinite(known)]
    ratio = np.empty(0)
    error = bias = np.inf
    while error > settings.error and ratio.size < order.size:
        more = order[ratio.size : ratio.size + BATCH]
        new, resolved = _ratios(contact, settings, more, base, checks.size + ratio.size)
        ratio, kept = np.append(ratio, new), min(kept, resolved)
        found = np.isfinite(ratio)
        if few or found.sum() < 4:
            continue
        guess = _interpolated(place[order[: ratio.size][found]], ratio[found], place[checks])
        off = guess[np.isfinite(known)] / trusted - 1
        error, bias = float(np.mean(np.abs(off))), float(np.mean(off))
    solved = np.append(order[: ratio.size], checks)
    ratios = np.append(ratio, known)
    found = np.isfinite(ratios)
    if not (few or np.isfinite(error)) or np.mean(~found) > LARGEST_LEFT_OUT:
        raise ConvergenceError(
            f"{np.count_nonzero(~found)} of {found.size} contacts of the {contact.mesh.name} have "
            "no solution. Use another models.friction."
        )
    return _Solved(
        contact.force,
        place[solved[found]],
        ratios[found],
        limits,
        f"models.friction ehl-direct: {found.size} contacts of the {contact.mesh.name} solved, "
        f"{np.count_nonzero(~found)} of them without convergence and left out; "
        + ("these are all the different ones." if few else _errors(error, bias, settings.error))
        + _limits_left(contact, power)
        + _unresolved(kept),
    )


def _errors(error: float, bias: float, wanted: float) -> str:
    """What to say of the error of interpolated contacts."""
    missed = "" if error <= wanted else f", above the target of {percent(wanted)}"
    return (
        f"error of interpolated contacts {percent(error)} on average{missed}, of their power "
        f"{percent(bias, signed=True)}."
    )


def _limits_left(contact: MeshContact, power: FloatArray) -> str:
    """What to say of film ratios and speeds at which the solver is not to be relied on."""
    told = ""
    for beyond, what in (
        (
            contact.film_ratio < VALIDATED_FILM_RATIO,
            f"at film ratios below {VALIDATED_FILM_RATIO:g}, for which the solver is not "
            "validated.",
        ),
        (
            contact.rolling_speed < DRY_SPEED,
            f"at less than {DRY_SPEED:g} m/s, where oil leaks out of the valleys of real surfaces "
            "and increases their friction.",
        ),
    ):
        # no share of no power
        if power[beyond].sum() > SMALLEST_SHOWN_SHARE * power.sum():
            share = power[beyond].sum() / power.sum()
            told += f" {percent(share, 0)} of the sliding power is {what}"
    return told


def _unresolved(kept: float) -> str:
    """What to say of roughness that the grid does not resolve."""
    if kept >= FEWEST_KEPT:
        return ""
    return (
        f" In the widest contact solved the nodes resolve {percent(kept, 0)} of the Rq; shorter "
        "waves are lost. Raise contact_solver.correlation_length, if the finish allows it."
    )


def _spread(values: FloatArray, limits: FloatArray) -> FloatArray:
    """`values` from their `limits` over to -1 to 1; those that are alike to -1."""
    low, high = limits
    width = np.where(high - low > ALIKE, high - low, np.inf)
    spread: FloatArray = 2 * (values - low) / width - 1
    return spread


def _quantiles(path: FloatArray, power: FloatArray, usable: IntArray) -> IntArray:
    """Points at even shares of the sliding power along the path."""
    order = usable[np.argsort(path[usable], kind="stable")]
    share = np.cumsum(power[order]) / power[order].sum()
    wanted = (np.arange(CHECKS) + 0.5) / CHECKS
    return np.unique(order[np.minimum(np.searchsorted(share, wanted), order.size - 1)])


def _spread_out(place: FloatArray, count: int) -> IntArray:
    """Points each as far as possible from those before it, the first one in the middle."""
    chosen = [int(np.argmin((place**2).sum(axis=1)))]
    distance = np.full(len(place), np.inf)
    while len(chosen) < min(count, len(place)):
        distance = np.minimum(distance, ((place - place[chosen[-1]]) ** 2).sum(axis=1))
        chosen.append(int(np.argmax(distance)))
    return np.array(chosen)


def _interpolated(known: FloatArray, ratio: FloatArray, place: FloatArray) -> FloatArray:
    """Ratios at `place` by thin-plate splines of their logarithm, within what was found.

    Where places lie on a line, as under an even load, by the sum of cones instead.
    """
    from scipy.interpolate import RBFInterpolator

    spans_plane = np.linalg.matrix_rank(np.insert(known, 0, 1.0, axis=1)) > known.shape[1]
    kernel, degree = ("thin_plate_spline", 1) if spans_plane else ("linear", 0)
    spline = RBFInterpolator(
        known, np.log(ratio), smoothing=SMOOTHING, kernel=kernel, degree=degree
    )
    logarithm = np.clip(spline(place), np.log(ratio.min()), np.log(ratio.max()))
    values: FloatArray = np.exp(logarithm)
    return values


def _ratios(
    contact: MeshContact, settings: DirectSettings, points: IntArray, base: FloatArray, done: int
) -> tuple[FloatArray, float]:
    """Friction over `base` at some points, after others, and the least share of Rq resolved.

    Not a number without a solution.
    """
    oil = contact_oil(contact.oil, settings.laws)
    effusivity = settings.effusivity
    heating = None if effusivity is None else heating_of(contact.oil, effusivity, effusivity)
    smooth = bool(contact.film_ratio.min() > SMOOTH_FILM_RATIO)
    found, kept = [], 1.0
    for i in points:
        line = line_contact(contact, int(i), oil)
        roughness = (0.0, 0.0) if smooth else contact.roughness
        seeds = np.random.SeedSequence([settings.seed, int(i)]).generate_state(2)
        pair = (int(seeds[0]), int(seeds[1]))
        friction, resolved = _friction(line, roughness, pair, heating, settings)
        found.append(abs(friction))
        kept = min(kept, resolved)
        CONTACT_PROGRESS.get()(done + len(found), done + points.size)
    return np.array(found) / base[points], kept


@lru_cache(maxsize=4096)
def _friction(
    line: LineContact,
    roughness: tuple[float, float],
    seeds: tuple[int, int],
    heating: Heating | None,
    settings: DirectSettings,
) -> tuple[float, float]:
    """Friction of one contact, not a number without a solution, and share of Rq resolved. [1]"""
    with one_thread():
        if max(roughness) == 0:
            smooth = solve_smooth(line, heating=heating)
            converged = smooth.status is Status.CONVERGED
            return smooth.friction_coefficient if converged else np.nan, 1.0
        length = settings.correlation_length
        one, two = (
            generate_profile(rms, length, PERIOD * length, seed)
            for rms, seed in zip(roughness, seeds, strict=True)
        )
        rough = solve_rough(line, one, two, settings.asperities, heating=heating, most_blocks=BRIEF)
    known = rough.friction_error <= LARGEST_ERROR * abs(rough.friction_coefficient)
    unsolved = rough.unsolved_steps > LARGEST_UNSOLVED_SHARE * max(rough.steps, 1)
    if not known or unsolved:
        return np.nan, 1.0
    return rough.friction_coefficient, rough.roughness_kept
