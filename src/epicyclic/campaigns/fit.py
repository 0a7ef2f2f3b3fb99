"""From the table of a campaign to the models of an oil."""

from __future__ import annotations

from importlib import metadata
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from epicyclic.campaigns.design import AXES, quantity_of_axis
from epicyclic.campaigns.folder import CampaignFolder, column_of
from epicyclic.case.contact import contact_model
from epicyclic.errors import InputError, Problem
from epicyclic.lubricant.properties import oil_state
from epicyclic.oilmodel.fitting import fit_quantity
from epicyclic.oilmodel.model import FORMAT, OilModel, QuantityFit
from epicyclic.oilmodel.states import ContactStates

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["fit_campaign", "simulated_quantities"]

FloatArray = NDArray[np.float64]

LARGEST_ERROR = 0.10
"""Standard error of a simulated friction over it above which it is not fitted. [1]"""
LARGEST_UNSOLVED_SHARE = 0.01
"""Share of time steps without convergence above which a simulation is not fitted. [1]"""
SCATTER = 0.05
"""Relative error that a form has anyway: smaller ones of a simulation do not count more. [1]"""
QUANTITIES = {
    "friction": ("gear", "friction", "1"),
    "rolling_loss": ("gear", "smooth_rolling_loss", "W/m"),
    "bearing_rolling_loss": ("bearing", "rolling_loss", "W/m"),
}
"""What is fitted: to which contacts, to which column, in which unit."""


def fit_campaign(folder: CampaignFolder) -> OilModel:
    """Fit friction and rolling loss to all simulations that are good enough.

    Theory (O8).

    A simulation counts if nearly all of its time steps converged and its friction is known to
    10 %, whether or not it reached the 2 % at which it is called converged.

    Raises
    ------
    InputError
        If there are too few of them.
    """
    campaign = folder.campaign
    fits: dict[str, QuantityFit] = {}
    reasons = []
    for quantity, (states, target, weight) in simulated_quantities(folder).items():
        unit = QUANTITIES[quantity][2]
        try:
            fits[quantity] = fit_quantity(quantity, unit, states, target, weight)
        except ValueError as error:
            given = f"{target.size} simulations"
            remedy = "Simulate more contacts."
            reasons.append(Problem(quantity, given, f"not fitted: {error}.", remedy))
    if reasons:
        raise InputError(reasons, str(folder.path))
    frame = folder.read()
    return OilModel(
        format=FORMAT,
        version=metadata.version("epicyclic"),
        settings=campaign.describe()["settings"],
        designs=tuple(campaign.describe()["designs"]),
        seed=campaign.seed,
        simulations={
            "simulated": len(frame),
            "not converged": int(frame["status"].eq("failed").sum()),
            "fitted": int(_good(frame).sum()),
        },
        notes=(
            "Rolling losses of gear contacts are those of the smooth contacts, of bearing contacts "
            "those of the rough ones.",
            "Errors are those against the simulations, not against measurements.",
        ),
        equivalent_modulus=_modulus(folder),
        fits=fits,
    )


def simulated_quantities(
    folder: CampaignFolder,
) -> dict[str, tuple[ContactStates, FloatArray, FloatArray]]:
    """Conditions, value and weight of the simulations that are good enough, by quantity."""
    frame = folder.read()
    good = _good(frame)
    found = {}
    for quantity, (part, column, _) in QUANTITIES.items():
        if frame["part"].eq(part).any():
            rows = frame[good & frame["part"].eq(part) & frame[column].gt(0)]
            states = _states(rows, folder)
            found[quantity] = (states, rows[column].to_numpy(), _weights(rows, column))
    return found


def _good(frame: pd.DataFrame) -> pd.Series:
    """Which simulations are fitted."""
    known = frame["friction"].gt(0) & frame["friction_error"].le(LARGEST_ERROR * frame["friction"])
    return frame["unsolved_share"].le(LARGEST_UNSOLVED_SHARE) & (
        known | frame["part"].eq("bearing")
    )


def _modulus(folder: CampaignFolder) -> float:
    """E_eq of all simulations. [Pa]"""
    return contact_model(folder.campaign.case(0)).contact.equivalent_modulus


def _states(rows: pd.DataFrame, folder: CampaignFolder) -> ContactStates:
    """Conditions of some simulations, SI."""
    values: dict[str, FloatArray] = {}
    for name in AXES:
        scale, offset = quantity_of_axis(name).scale_and_offset()
        values[name] = (rows[column_of(name)].to_numpy(dtype=float) - offset) / scale
    oil = folder.campaign.case(0).lubricant.oil
    states = [oil_state(oil, float(temperature)) for temperature in values.pop("temperature")]
    return ContactStates(
        **values,
        dynamic_viscosity=np.array([state.dynamic_viscosity for state in states]),
        pressure_viscosity=np.array([state.pressure_viscosity for state in states]),
        equivalent_modulus=_modulus(folder),
    )


def _weights(rows: pd.DataFrame, column: str) -> FloatArray:
    """What each simulation counts: less where its friction is known less well."""
    if column != "friction":
        return np.ones(len(rows))
    error: FloatArray = (rows["friction_error"] / rows["friction"]).to_numpy()
    weight: FloatArray = SCATTER**2 / (SCATTER**2 + error**2)
    return weight
