"""The main formulas of the losses as functions of numbers and arrays, without a case.

Arguments are in SI units, or texts with a unit ("20 mm"), each one value or an array of values;
arrays are broadcast against each other as numpy does it. Results are arrays in SI units.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from numbers import Real
from operator import attrgetter
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
from pydantic_core import PydanticCustomError

from epicyclic.arrays import FloatArray
from epicyclic.build.elements import build_element
from epicyclic.build.machine import oil_medium
from epicyclic.case.gear_tables import Teeth as TeethTable
from epicyclic.case.tables.base import Roughness
from epicyclic.case.tables.elements import Force, ShaftBearingTable
from epicyclic.case.tables.models import GearPairModels
from epicyclic.case.tables.operation import Lubricant
from epicyclic.contact.line_contact import Flanks, LineContacts
from epicyclic.errors import InputError, Problem, one_problem, raise_any
from epicyclic.gears.gear import involute
from epicyclic.losses.friction import FRICTION_MODELS, FrictionSettings
from epicyclic.losses.journal_bearing import JournalBearing, JournalState, solve_journal
from epicyclic.losses.rolling import ROLLING_MODELS
from epicyclic.losses.shaft_bearing import BearingLoad
from epicyclic.losses.windage import (
    DRAG_METHODS,
    LAMINAR_RIMS,
    MIST_SHARE,
    DragModel,
    Teeth,
    Turning,
    drag,
)
from epicyclic.losses.zhou_hoeprich import STEEL
from epicyclic.machine.convection import STANDARD_PRESSURE
from epicyclic.machine.shaft_parts import ShaftBearing
from epicyclic.messages import did_you_mean, refused, written
from epicyclic.oil.oil import Oil, mixture_state, oil_state
from epicyclic.schema.fields import quantity_of
from epicyclic.schema.read import plain
from epicyclic.schema.validation import validate
from epicyclic.units import (
    METRE_PER_SECOND,
    NEWTON_PER_MM,
    Conductance,
    Length,
    Modulus,
    RotationalSpeed,
    SmallLength,
    Speed,
    Temperature,
    Torque,
)

OilName = str | Mapping[str, Any]
ALPHA = math.radians(20)  # Pressure angle of the basic rack (ISO 53). [rad]
LOCAL_FRICTION = (
    "mixed-lubrication", "mixed-ehl", "mixed-ehl+pairing", "xu-2007", "benedict-kelley",
    "matsumoto", "doleschel",
)  # fmt: skip
"""Friction models that need no more than the contact; the others are means over a gear mesh."""

_LINE_LOAD = replace(NEWTON_PER_MM, low=0.0, high=1e6)
_MEASURES: dict[str, Any] = {
    "line_load": Annotated[float, _LINE_LOAD],
    "radius": Length,
    "rolling_speed": Speed,
    "sliding_speed": Annotated[float, METRE_PER_SECOND],
    "roughness1": SmallLength,
    "roughness2": SmallLength,
    "roughness": Roughness,
    "modulus": Modulus,
    "conductance": Conductance,
    "temperature": Temperature,
    "diameter": Length,
    "pitch_diameter": Length,
    "width": Length,
    "length": Length,
    "clearance": Length,
    "speed": RotationalSpeed,
    "force": Force,
    "moment": Torque,
    "radial_force": Force,
    "axial_force": Force,
}
"""What the arguments measure, with the ranges of a case."""


def _si(key: str, given: Any) -> FloatArray:
    """Numbers in SI, and texts with units."""
    if not isinstance(given, str) and np.ndim(given):
        if not np.size(given):
            raise one_problem(key, written(given), "has no values.", "Give one or more.")
        return np.array([_si(key, one) for one in given])
    quantity = quantity_of(_MEASURES[key])
    assert quantity is not None
    is_number = isinstance(given, int | float | np.number) and not isinstance(given, bool)
    try:
        return np.array(quantity.parse(f"{float(given)!r} {quantity.si}" if is_number else given))
    except PydanticCustomError as error:
        raise InputError([refused(error, key, written(given))]) from None


def _each(function: Callable[..., tuple[Any, ...]], **given: Any) -> list[FloatArray]:
    """The results of a function of numbers in SI, one array for each of them."""
    arrays = np.broadcast_arrays(*(_si(key, value) for key, value in given.items()))
    found = [function(*map(float, point)) for point in zip(*map(np.ravel, arrays), strict=True)]
    return [
        np.array(column, dtype=float).reshape(arrays[0].shape)
        for column in zip(*found, strict=True)
    ]


def _oil(given: OilName) -> Oil:
    read = validate(Lubricant, {"oil": given})
    if read.case is None:
        raise InputError(read.problems)
    return read.case.oil


def _chosen(name: str, known: Mapping[Any, Any], among: tuple[str, ...]) -> Any:
    if name not in among:
        allowed = f"must be one of {', '.join(among)}."
        raise one_problem("model", written(name), allowed, "Choose one of them.")
    return known[name]


def oil_properties(oil: OilName, temperature: Any) -> dict[str, FloatArray]:
    """Viscosity, density and pressure-viscosity coefficient of an oil.

    lg lg (nu + 0.7) = A - B lg T (ASTM D341), a density linear in T, and the pressure-viscosity
    coefficient by Gold's constants or Roelands' equation. See (L3) in the theory.

    Parameters
    ----------
    oil : str or mapping
        A name of the oil library, or a table as below ``[lubricant]``: ``{"iso_vg": 220}``.
    temperature : float, str or array_like
        [K], or ``"90 degC"``.

    Returns
    -------
    dict of str to ndarray
        In SI: "kinematic_viscosity" [m^2/s], "dynamic_viscosity" [Pa s], "density" [kg/m^3],
        "pressure_viscosity" [1/Pa], "thermal_conductivity" [W/(m K)].

    Examples
    --------
    >>> import epicyclic as ep
    >>> found = ep.oil_properties("iso-vg-100-pao", ["40 degC", "100 degC"])
    >>> (1e6 * found["kinematic_viscosity"]).round(1).tolist()
    [100.0, 15.3]
    """
    names = (
        "kinematic_viscosity",
        "dynamic_viscosity",
        "density",
        "pressure_viscosity",
        "thermal_conductivity",
    )
    liquid, stated = _oil(oil), attrgetter(*names)
    columns = _each(lambda kelvin: stated(oil_state(liquid, kelvin)), temperature=temperature)
    return dict(zip(names, columns, strict=True))


class LineContact(NamedTuple):
    """Pressure and film of line contacts, SI."""

    hertz_pressure: FloatArray  # p_h. [Pa]
    half_width: FloatArray  # b_h. [m]
    minimum_film: FloatArray  # h_min. [m]
    film_ratio: FloatArray  # h_min over sqrt(Rq1^2 + Rq2^2). [1]


_LOCAL = "line_load", "radius", "rolling_speed", "sliding_speed"
_USUAL = {"modulus": STEEL, "roughness1": "0.4 um", "roughness2": "0.4 um", "sliding_speed": 0.0}


def _at_contacts(
    function: Callable[[LineContacts], tuple[Any, ...]], given: Mapping[str, Any]
) -> list[FloatArray]:
    """What a function makes of each contact."""
    names = ("modulus", "roughness1", "roughness2", "temperature", *_LOCAL)
    known, contact = (*names, "oil"), {**_USUAL, **given}
    others = [key for key in given if key not in known]
    advice = f"Give some of {', '.join(known)}."
    problems = [
        Problem(it, "", "is not a known argument.", did_you_mean(it, known) or advice)
        for it in others
    ]
    lacking = (key for key in known if key not in contact)
    problems += [Problem(key, "", "is missing.", f'Give it: {key} = "...".') for key in lacking]
    raise_any(problems, "the contact")
    liquid = _oil(contact["oil"])

    def at(e_eq: float, rq1: float, rq2: float, t: float, *local: float) -> tuple[float, ...]:
        load, own, rolling, sliding = (np.array([one]) for one in local)
        flanks = Flanks(e_eq, rq1, rq2)
        contact = LineContacts(load, own, rolling, sliding, flanks, oil_state(liquid, t))
        return tuple(float(np.ravel(one)[0]) for one in function(contact))

    return _each(at, **{name: contact[name] for name in names})


def line_contact(**contact: Any) -> LineContact:
    """Hertz pressure and film thickness of a lubricated line contact.

    b_h = sqrt(8 W' R/(pi E_eq)), p_h = 2 W'/(pi b_h) (Johnson 1985, Eq. 4.43) and h_min/R = 1.714
    U^0.694 G^0.568 W^-0.128 of smooth, isothermal contacts (Pan and Hamrock 1989).
    See (C10) in the theory.

    Parameters
    ----------
    line_load : float, str or array_like
        W' [N/m], or ``"300 N/mm"``.
    radius : float, str or array_like
        Equivalent radius of curvature R, 1/R = 1/r_1 + 1/r_2. [m]
    rolling_speed : float, str or array_like
        (u_1 + u_2)/2. [m/s]
    temperature : float, str or array_like
        Of the oil at the inlet. [K]
    oil : str or mapping
        As for `oil_properties`.
    roughness1, roughness2 : float, str or array_like
        Rms roughness Rq of both surfaces. [m]
    modulus : float, str or array_like
        E_eq = 2/[(1 - nu1^2)/E1 + (1 - nu2^2)/E2]. Default: steel on steel. [Pa]

    Returns
    -------
    LineContact
        In Pa, m, m and 1.

    Examples
    --------
    >>> import epicyclic as ep
    >>> found = ep.line_contact(line_load=["100 N/mm", "300 N/mm"], radius="12 mm",
    ...     rolling_speed="7 m/s", temperature="70 degC", oil="iso-vg-100-pao")
    >>> (1e-6 * found.hertz_pressure).round(0).tolist()
    [548.0, 949.0]
    >>> (1e6 * found.minimum_film).round(2).tolist()
    [0.61, 0.53]
    """
    names = ("hertz_pressure", "hertz_half_width", "minimum_film", "film_ratio")
    return LineContact(*_at_contacts(attrgetter(*names), contact))


def friction(model: str, **contact: Any) -> FloatArray:
    """Coefficient of friction of a line contact by one of the models of gear flanks.

    Parameters
    ----------
    model : str
        A local model of ``models.friction``: ``"mixed-lubrication"`` (this package, any oil),
        ``"mixed-ehl"`` (Talbot 2012, Eq. 5.8), ``"mixed-ehl+pairing"``, ``"xu-2007"``,
        ``"benedict-kelley"`` (1961), ``"matsumoto"`` (2014) or ``"doleschel"`` (2002).
        See (F6) in the theory.
        Models that are means over a mesh need a case: see `solve`.
    **contact
        As for `line_contact`, with ``sliding_speed``, u_1 - u_2. [m/s]

    Returns
    -------
    ndarray
        mu. [1]

    Examples
    --------
    >>> import epicyclic as ep
    >>> mu = ep.friction("benedict-kelley", line_load="300 N/mm", radius="12 mm",
    ...     rolling_speed="7 m/s", sliding_speed=["1 m/s", "3 m/s"], temperature="70 degC",
    ...     oil="iso-vg-100-pao")
    >>> mu.round(4).tolist()
    [0.0596, 0.0507]
    """
    chosen = _chosen(model, FRICTION_MODELS, LOCAL_FRICTION)
    settings = FrictionSettings(fluid=GearPairModels.model_fields["fluid_friction"].default)
    return _at_contacts(lambda it: (chosen.function(it, settings),), contact)[0]


def rolling_loss(model: str, **contact: Any) -> FloatArray:
    """Rolling loss per length of a line contact.

    Parameters
    ----------
    model : str
        ``"goksem-hargreaves"`` (1978; (R7) in the theory), ``"mixed-ehl"`` (Talbot 2012,
        Eq. 5.10; (R5)) or ``"mixed-ehl+pairing"``.
    **contact
        As for `line_contact`; the regressions take ``sliding_speed``, u_1 - u_2, too. [m/s]

    Returns
    -------
    ndarray
        [W/m]

    Examples
    --------
    >>> import epicyclic as ep
    >>> loss = ep.rolling_loss("goksem-hargreaves", line_load="300 N/mm", radius="12 mm",
    ...     rolling_speed=["5 m/s", "9 m/s"], temperature="70 degC", oil="iso-vg-100-pao")
    >>> loss.round(0).tolist()
    [1116.0, 2704.0]
    """
    local = tuple(name for name in ROLLING_MODELS if name != "fitted")
    chosen = _chosen(model, ROLLING_MODELS, local)
    return _at_contacts(lambda it: (chosen.loss_density(it),), contact)[0]


def windage(
    *,
    diameter: Any,
    width: Any,
    speed: Any,
    temperature: Any,
    oil: OilName,
    oil_share: float = 0.05,
    teeth: int | None = None,
    pitch_diameter: Any = None,
    model: DragModel = "diab-ville-velex",
) -> FloatArray:
    """Drag of a disc, or of a gear, that turns in a mixture of oil and air.

    P = omega T of the rim, tau = C_d rho (omega r)^2/2, and of both faces, T = C_M rho omega^2
    r^5/2, laminar to turbulent (Theodorsen and Regier 1944; von Karman); with ``teeth`` also what
    the teeth pump (Diab et al. 2004), or all of it by the formula of Anderson and Loewenthal.
    See (V11), (V12), (V13) in the theory.

    Parameters
    ----------
    diameter, width : float, str or array_like
        Of the disc; of a gear its tip diameter and face width. [m]
    speed : float, str or array_like
        [rad/s], or ``"9000 rpm"``.
    temperature, oil
        Of the oil, as for `oil_properties`; the air has the same temperature and 1.01325 bar.
    oil_share : float
        Volume of oil in the mixture. [1]
    teeth : int, optional
        Number of teeth, of 20 deg and without profile shift.
    pitch_diameter : float, str or array_like, optional
        Reference diameter of the teeth. Default: d_a z/(z + 2), that of full depth. [m]
    model : str
        ``"diab-ville-velex"``, ``"anderson-loewenthal"``, which is for mist of one part of oil in
        34.25 of air whatever `oil_share` is, or ``"theodorsen-regier"``, without teeth.

    Returns
    -------
    ndarray
        [W]

    Examples
    --------
    >>> import epicyclic as ep
    >>> loss = ep.windage(diameter="200 mm", width="30 mm", speed=["3000 rpm", "9000 rpm"],
    ...     temperature="80 degC", oil="atf-dexron-vi", oil_share=0.01)
    >>> loss.round(1).tolist()
    [107.1, 1779.7]
    >>> gear = ep.windage(diameter="296 mm", width="30 mm", speed="700 rad/s", teeth=72,
    ...     temperature="30 degC", oil="iso-vg-100-pao", oil_share=0.0)
    >>> round(float(gear))  # of it 183 W of rim and faces
    1076
    """
    liquid = _oil(oil)
    _chosen(model, DRAG_METHODS, tuple(name for name in DRAG_METHODS if name != LAMINAR_RIMS))
    if not (isinstance(oil_share, Real) and 0 <= oil_share <= 1):
        allowed = "must be from 0 to 1."
        raise one_problem("oil_share", written(oil_share), allowed, "Give parts of the volume.")
    if teeth is not None:
        raise_any(validate(TeethTable, {"teeth": plain(teeth)}).problems)

    def at(size: float, face: float, omega: float, t: float, pitch: float) -> tuple[float]:
        state = oil_state(liquid, t)
        toothed = None
        if teeth:
            tip_angle = math.acos(min(1.0, pitch / size * math.cos(ALPHA)))
            tip_half = math.pi / (2 * teeth) + involute(ALPHA) - involute(tip_angle)
            toothed = Teeth(teeth, pitch / 2, size / 2, face, 2 * (math.pi / teeth - tip_half))
        mixture = mixture_state(state, oil_share, STANDARD_PRESSURE)
        mist = mixture_state(state, min(oil_share, MIST_SHARE), STANDARD_PRESSURE)
        body = Turning(size / 2, face, toothed)
        return (sum(drag(body, omega, mixture, mist, state.dynamic_viscosity, model)),)

    pitch = pitch_diameter
    if pitch is None:
        pitch = _si("diameter", diameter) * (teeth / (teeth + 2) if teeth else 1.0)
    elif teeth is None or np.any(_si("pitch_diameter", pitch) > _si("diameter", diameter)):
        allowed = "is the reference diameter of teeth, whose tips are at diameter."
        raise one_problem("pitch_diameter", written(pitch), allowed, "Correct it, or give teeth.")
    return _each(
        at, diameter=diameter, width=width, speed=speed, temperature=temperature,
        pitch_diameter=pitch,
    )[0]  # fmt: skip


def bearing_loss(
    designation: str,
    *,
    speed: Any,
    temperature: Any,
    oil: OilName,
    radial_force: Any,
    axial_force: Any = 0.0,
    model: Literal["auto", "houpert", "palmgren", "harris", "zhou-hoeprich"] = "auto",
) -> FloatArray:
    """Loss of a rolling bearing by its designation.

    Sizes follow from the ISO plans and load ratings are estimated (ISO 281, ISO 76; (J27)
    in the theory). The friction of balls is by their films, (J42), that of tapered, caged
    cylindrical and thrust rollers after Zhou and Hoeprich (1991), of others Palmgren's.

    Parameters
    ----------
    designation : str
        ``"6208"``, ``"NU 2210"``, ``"32006"``, ``"NKI 40/30"``.
    speed : float, str or array_like
        Of one ring against the other. [rad/s]
    temperature, oil
        Of the oil in the bearing, as for `oil_properties`.
    radial_force, axial_force : float, str or array_like
        [N]
    model : str
        As in ``[bearings.NAME]``.

    Returns
    -------
    ndarray
        [W]

    Examples
    --------
    >>> import epicyclic as ep
    >>> ep.bearing_loss("6208", speed=["1500 rpm", "6000 rpm"], temperature="70 degC",
    ...     oil="iso-vg-100-pao", radial_force="2 kN").round(1).tolist()
    [8.1, 53.3]
    """
    liquid = _oil(oil)
    forces = {"radial_force": radial_force, "axial_force": axial_force}
    given = {"shaft": "shaft", "designation": designation, "model": model}
    given |= {key: f"{np.max(_si(key, force))} N" for key, force in forces.items()}
    read = validate(ShaftBearingTable, given)
    raise_any(read.problems or [*read.case.problems()] if read.case else read.problems)
    assert read.case is not None
    made = build_element(
        "bearings", "bearing", read.case, shafts={"shaft": "shaft"}, oil=liquid, folder=Path()
    )
    assert isinstance(made, ShaftBearing)

    def at(omega: float, t: float, radial: float, axial: float) -> tuple[float]:
        parts = made.model.parts(
            made.bearing, BearingLoad(radial, axial), omega, oil_state(liquid, t)
        )
        return (sum(part.watts for part in parts),)

    return _each(at, speed=speed, temperature=temperature, **forces)[0]


def plain_pin(
    *,
    diameter: Any,
    length: Any,
    clearance: Any,
    force: Any,
    speed: Any,
    temperature: Any,
    oil: OilName,
    roughness: Any = "0.5 um",
    conductance: Any = 0.0,
    moment: Any = 0.0,
) -> dict[str, FloatArray]:
    """Film, temperature and loss of a journal bearing: a planet on a plain pin.

    Reynolds' equation of a short to long bearing with the mean temperature of its film, asperities
    of Greenwood and Tripp where the film is thin. See (Z3), (Z5), (Z7) in the theory.

    Parameters
    ----------
    diameter, length, clearance : float, str or array_like
        Of the pin, of the bore, and the difference of their diameters. [m]
    force : float, str or array_like
        [N]
    speed : float, str or array_like
        [rad/s]
    temperature, oil
        Of the oil as it enters, as for `oil_properties`.
    roughness : float, str or array_like
        Rms, of both surfaces together. [m]
    conductance : float, str or array_like
        From the film to pin and planet; 0: all heat leaves with the oil. [W/K]
    moment : float, str or array_like
        Tilts the planet, in the plane of its axis across the force, as helical meshes do. [N m]

    Returns
    -------
    dict of str to ndarray
        ``watts`` and the fields of `epicyclic.losses.journal_bearing.JournalState`, SI.

    Examples
    --------
    >>> import epicyclic as ep
    >>> pin = ep.plain_pin(diameter="25 mm", length="30 mm", clearance="40 um", force="3 kN",
    ...     speed=["600 rpm", "2400 rpm"], temperature="60 degC", oil="iso-vg-100-pao")
    >>> pin["watts"].round(1).tolist(), (1e6 * pin["film"]).round(1).tolist()
    ([5.2, 40.8], [3.4, 8.0])
    """
    liquid = _oil(oil)
    names = ("watts", *(one.name for one in fields(JournalState)))

    def at(*values: float) -> tuple[float, ...]:
        inner, long, gap, rough, load, omega, t, couple, outward = values
        state = oil_state(liquid, t)
        bearing = JournalBearing(
            inner, long, gap, rough, STEEL / 2, state.boundary_friction, outward
        )
        capacity = oil_medium(liquid, t).heat_capacity
        found = solve_journal(bearing, load, omega, state, capacity, complex(0.0, couple))
        return tuple(getattr(found, name) for name in names)

    columns = _each(
        at, diameter=diameter, length=length, clearance=clearance, roughness=roughness,
        force=force, speed=speed, temperature=temperature, moment=moment,
        conductance=conductance,
    )  # fmt: skip
    return dict(zip(names, columns, strict=True))
