"""The oil of a REXS file to a table of properties."""

from __future__ import annotations

from collections.abc import Sequence

from epicyclic.exchange.rexs.draft import Amount, Draft, Lack
from epicyclic.exchange.rexs.model import Component, Model
from epicyclic.exchange.rexs.vocabulary import oil_kind

_KINDS = (
    "lubricant_type_iso_6336_2019",
    "lubricant_type_iso_6336_2006",
    "lubricant_type_agma_925_2003",
    "basis",
    "kind",
)
_VISCOSITIES = {
    "viscosity_at_40_degree_celsius": "40 degC",
    "viscosity_at_100_degree_celsius": "100 degC",
}
_DENSITY = "density_at_15_degree_celsius"
_ALPHA = "pressure_viscosity_coefficient_at_38_degrees_celsius"
_AGMA = "parameter_{}_for_calculation_of_pressure_viscosity_coefficient_agma_925_2003"
_OR_NAME = "Or name an oil of the library in its place: lubricant.oil."


def lubricant_table(draft: Draft, model: Model, stages: Sequence[Component]) -> None:
    """The oil of the stages, or else of the casing."""
    oils: dict[int, Component] = {}
    for owner in (*stages, *model.of_type("gear_casing")):
        for oil in model.partners(owner.id, "reference", "origin", "referenced", "lubricant"):
            oils.setdefault(oil.id, oil)
    if not oils:
        draft.lack("lubricant.oil", "lubricant", stages)
        return
    oil = next(iter(oils.values()))
    if len(oils) > 1:
        draft.notes.append(f"The file has {len(oils)} lubricants for this set; {oil} is taken.")
    name = oil.get("name")
    draft.give("lubricant.oil.title", name.text() if name else str(oil), f"{oil}")
    _kind(draft, oil)
    _viscosity(draft, oil)
    density = draft.read(_DENSITY, [oil], "lubricant.oil.density")
    if density is None:
        draft.lack("lubricant.oil.density", _DENSITY, [oil], "")
    else:
        point = {"temperature": "15 degC", "value": density.text}
        draft.give("lubricant.oil.density", [point], density.origin)
    _pressure_viscosity(draft, oil, density)


def _kind(draft: Draft, oil: Component) -> None:
    for attribute in _KINDS:
        found = oil.get(attribute)
        kind = None if found is None else oil_kind(found.text())
        if found is not None and kind is not None:
            draft.give("lubricant.oil.kind", kind, f'{found.id} "{found.text()}" of {oil}')
            return
    draft.lack("lubricant.oil.kind", "basis, or lubricant_type_iso_6336_2019,", [oil])


def _viscosity(draft: Draft, oil: Component) -> None:
    points, origins = [], []
    for attribute, temperature in _VISCOSITIES.items():
        found = draft.read(attribute, [oil], "lubricant.oil.kinematic_viscosity")
        if found is not None:
            points.append({"temperature": temperature, "value": found.text})
            origins.append(found.origin)
    if len(points) == len(_VISCOSITIES):
        draft.give("lubricant.oil.kinematic_viscosity", points, " and ".join(origins))
    else:
        draft.lack("lubricant.oil.kinematic_viscosity", " and ".join(_VISCOSITIES), [oil], "")


def _pressure_viscosity(draft: Draft, oil: Component, density: Amount | None) -> None:
    """alpha of the file at 38 degC, or alpha = k eta^s of AGMA 925-A03 as the law of Gold."""
    key = "lubricant.oil.pressure_viscosity"
    alpha = draft.read(_ALPHA, [oil], key)
    if alpha is not None:
        point = {"temperature": "38 degC", "value": alpha.text}
        draft.give(key, {"law": "roelands", "point": [point]}, alpha.origin)
        return
    factor, exponent = (draft.read(_AGMA.format(name), [oil], key) for name in "ks")
    if factor and exponent and density and density.unit == "kg/dm^3":
        # alpha in mm^2/N is 1000 times that in 1/GPa, eta in mPa s is nu in mm^2/s times rho in
        # kg/dm^3; rho at 15 degC in place of that at temperature changes alpha by 1 %
        s = 1000 * factor.number * density.number**exponent.number
        law = {"law": "gold", "s": float(f"{s:.6g}"), "t": exponent.number}
        draft.give(
            key, law, f"computed from {factor.origin}, parameter s and the density at 15 degC"
        )
        return
    draft.lacks[key] = Lack(key, f"{_ALPHA} of {oil}", True, _OR_NAME)


def temperature(draft: Draft, model: Model, stages: Sequence[Component]) -> None:
    """Oil temperature of the stages, or else of the casing."""
    name, key = "temperature_lubricant", "operation.oil_inlet_temperature"
    if draft.take(key, name, stages, None) is None:
        draft.take(key, name, model.of_type("gear_casing") or stages)
