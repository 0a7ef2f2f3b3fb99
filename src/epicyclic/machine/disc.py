"""Bodies that turn in the air-oil mixture, or in a sump, and bearings that only churn oil."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import partial

from epicyclic.arrays import between
from epicyclic.dataclass import dataclass
from epicyclic.gears.gear import HOUSING
from epicyclic.losses.drag import (
    CHURNING_MODELS,
    JET_METHOD,
    JET_SOURCE,
    VISCOUS_METHOD,
    VISCOUS_SOURCE,
    ChurningModel,
    Dipped,
    NozzleSide,
    SumpOil,
    bearing_viscous_loss,
    churning_flags,
    disc_drag,
    disc_drag_flags,
    jet_loss,
    viscous_flags,
)
from epicyclic.losses.ranges import Flags, ModelUse, check_ranges
from epicyclic.losses.windage import (
    DISCS,
    DRAG_METHODS,
    JETS_IN_AIR,
    LAMINAR_RIMS,
    MIST_SHARE,
    DragModel,
    Turning,
    drag,
)
from epicyclic.machine.element import LOAD_INDEPENDENT, Loss, State

BESIDE: Mapping[str, tuple[DragModel, bool]] = {
    "theodorsen-regier": ("theodorsen-regier", False),
    "anderson-loewenthal": ("anderson-loewenthal", False),
    "diab-ville-velex": ("diab-ville-velex", False),
    "diab-ville-velex with all the oil": ("diab-ville-velex", True),
}
"""Models of the drag of gears that a result shows beside one another, and whether all oil flows."""

Outcome = tuple[Loss, Flags]


@dataclass(frozen=True, slots=True)
class Sump:
    """Oil that a body dips into."""

    part: Dipped  # How far it does.
    volume: float  # Volume of the oil. [m^3]
    model: ChurningModel  # Model of its churning.
    smooth: bool  # As of `SumpOil`.

    def power(self, model: ChurningModel, speed: float, state: State) -> float:
        """Churning power. [W]"""
        oil = state.fluids.oil
        known = SumpOil(oil.density, oil.kinematic_viscosity, self.volume, self.smooth)
        return CHURNING_MODELS[model].torque(self.part, speed, known) * abs(speed)


@dataclass(frozen=True, slots=True)
class Jets:
    """Jets of oil on the teeth of a set."""

    flow: float  # Flow of all of them, which the gears that turn share evenly. [m^3/s]
    speed: float  # Speed of the oil along the teeth. [m/s]
    side: NozzleSide
    pitch_radius: float  # Pitch radius of the gear that they meet. [m]


@dataclass(frozen=True, slots=True)
class Disc:
    """A body that turns in the mixture, or dips into a sump."""

    one_by_one = True

    where: str  # For the flags: ``"sun"``.
    body: str
    turning: Turning
    oil_fraction: float  # Oil in the mixture, by volume. [1]
    model: DragModel
    sump: Sump | None = None  # Oil that it dips into, which then drags in place of the mixture.
    jets: Jets | None = None
    against: str = HOUSING  # The body with which the mixture around it turns.
    count: int = 1  # Of bodies alike.

    @property
    def pointwise(self) -> bool:
        """Whether its sizes may be `Points`: not in a sump or under jets."""
        return self.sump is None and self.jets is None

    @property
    def dips(self) -> bool:
        """Whether it reaches into a sump."""
        return self.sump is not None and self.sump.part.immersed > 0


@dataclass(frozen=True, slots=True)
class ThrustBearing:
    """Thrust bearings that carry no load worth counting."""

    one_by_one = True

    between: tuple[str, str]  # The two bodies whose speeds differ.
    mean_diameter: float  # [m]
    viscous_factor: float  # f0. [1]
    count: int


def disc_loss(
    discs: Iterable[Disc],
    state: State,
    struck: int = 1,  # Gears that turn and share the oil of the jets.
) -> Outcome:
    """The drag of `discs` together, each on its own shaft, and its flags. Theory (N2)."""
    flags = Flags()
    drags: dict[tuple[str, str], float] = {}
    methods: dict[str, str] = {}
    by_model: dict[str, float] = {}
    for disc in discs:
        speed = state.speeds[disc.body] - state.speeds[disc.against]
        body = disc.turning
        if (sump := disc.sump) is not None and disc.dips:
            model = CHURNING_MODELS[sump.model]
            watts = sump.power(sump.model, speed, state)
            about = sump.model, disc.where, sump.part, speed, sump.volume
            flags += Flags(partial(churning_flags, *about))
            title, methods[model.title] = model.title, model.source
        else:
            mixture = state.fluids.mixed(disc.oil_fraction)
            if disc.model == LAMINAR_RIMS:
                smooth = disc_drag(body.radius, body.width, speed, mixture)
                watts = sum(smooth)
                flags += Flags(
                    partial(disc_drag_flags, disc.where, body.radius, smooth, speed, mixture)
                )
            else:
                mist = state.fluids.mixed(between(disc.oil_fraction, None, MIST_SHARE))
                viscosity = state.fluids.oil.dynamic_viscosity
                parts = drag(body, speed, mixture, mist, viscosity, disc.model)
                watts = disc.count * sum(parts)
                limit, part = DISCS, parts.faces
                if disc.model == "anderson-loewenthal" and body.teeth is not None:
                    limit, part = JETS_IN_AIR, sum(parts)
                if part:
                    use = ModelUse("drag", disc.model, disc.where)
                    reynolds = abs(speed) * body.radius**2 / mixture.kinematic_viscosity
                    found = {"reynolds_number": reynolds, "oil_share": disc.oil_fraction}
                    concerned = part / sum(parts), disc.count * part
                    flags += Flags(partial(check_ranges, use, (limit,), found, 1.0, *concerned))
            title = DRAG_METHODS[disc.model].title
            methods[title] = DRAG_METHODS[disc.model].source
        if disc.jets is not None:
            watts += _jet_loss(disc.jets, speed, state, struck)
            methods[JET_METHOD] = JET_SOURCE
        pair = disc.body, disc.against  # of several discs, where a body has several gears
        drags[pair] = drags.get(pair, 0.0) + watts
        by_model[title] = by_model.get(title, 0.0) + watts
    total = sum(drags.values())
    brakes = tuple((*it, own / total) for it, own in drags.items() if own)
    several = by_model if total and len(by_model) > 1 else {}
    shares = tuple((title, own / total) for title, own in several.items())
    method, source = "; ".join(methods), "; ".join(methods.values())
    return Loss(LOAD_INDEPENDENT, total, method, source, brakes=brakes, shares=shares), flags


def _jet_loss(jets: Jets, speed: float, state: State, struck: int) -> float:
    """What the oil of jets takes from a gear. [W]"""
    if not speed:
        return 0.0
    pitch_speed = abs(speed) * jets.pitch_radius
    return jet_loss(
        state.fluids.oil.density, jets.flow / struck, pitch_speed, jets.speed, jets.side
    )


def drags_by_model(discs: Iterable[Disc], state: State) -> dict[str, float]:
    """Drag of the gears that do not dip, after each model that knows teeth. [W]

    The last one takes all the oil around the teeth for a fluid that flows through them.
    """
    oil, found = state.fluids.oil, dict.fromkeys(BESIDE, 0.0)
    for disc in discs:
        speed = state.speeds[disc.body] - state.speeds[disc.against]
        dips = disc.sump is not None and disc.dips
        if disc.turning.teeth is None or dips or not speed:
            continue
        whole = state.fluids.mixed(disc.oil_fraction)
        mist = state.fluids.mixed(min(disc.oil_fraction, MIST_SHARE))
        for name, (model, all_oil) in BESIDE.items():
            through = whole if all_oil else mist
            parts = drag(disc.turning, speed, whole, through, oil.dynamic_viscosity, model)
            found[name] += disc.count * sum(parts)
    return {name: watts for name, watts in found.items() if watts}


def churned(discs: Iterable[Disc], state: State) -> dict[str, float]:
    """Churning power of all bodies that dip, after each model. [W]"""
    sumps = [(disc.sump, state.speeds[disc.body]) for disc in discs if disc.dips]
    return {
        model: sum(sump.power(model, speed, state) for sump, speed in sumps if sump is not None)
        for model in CHURNING_MODELS
        if sumps
    }


def thrust_loss(bearing: ThrustBearing, state: State) -> Outcome:
    """Viscous loss of all thrust bearings. Theory (V2)."""
    one, two = bearing.between
    speed = state.speeds[one] - state.speeds[two]
    diameter, oil = bearing.mean_diameter, state.fluids.oil
    loss = bearing_viscous_loss(bearing.viscous_factor, oil.kinematic_viscosity, speed, diameter)
    watts, brakes = bearing.count * loss, ((*bearing.between, 1.0),)
    flags = Flags(partial(viscous_flags, "thrust bearing", speed, diameter, oil.dynamic_viscosity))
    return Loss(LOAD_INDEPENDENT, watts, VISCOUS_METHOD, VISCOUS_SOURCE, brakes=brakes), flags
