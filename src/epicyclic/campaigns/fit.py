"""From the table of a campaign to the models of an oil."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.campaigns.campaign import command_of, make_campaign
from epicyclic.campaigns.design import AXES, quantity_of_axis
from epicyclic.campaigns.folder import CampaignFolder, column_of
from epicyclic.case.contact import contact_model
from epicyclic.contact import LineContacts, contacts_at
from epicyclic.ehl.box import FEWEST_KEPT
from epicyclic.errors import InputError, Problem
from epicyclic.lubricant.properties import oil_state
from epicyclic.oilmodel.fitting import fit_quantity
from epicyclic.oilmodel.model import FORMAT, OilModel, QuantityFit
from epicyclic.sweeps.runner import Progress, Runner
from epicyclic.whole_file import write_file

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["characterise_oil", "fit_and_write", "fit_campaign", "simulated_quantities"]

FloatArray = NDArray[np.float64]

LARGEST_ERROR = 0.10
"""Standard error of a simulated mean over it above which it is not fitted. [1]"""
LARGEST_UNSOLVED_SHARE = 0.01
"""Share of time steps without convergence above which a simulation is not fitted. [1]"""
SCATTER = 0.05
"""Relative error that a form has anyway: smaller ones of a simulation do not count more. [1]"""
QUANTITIES = {
    "friction": ("gear", "friction", "1"),
    "rolling_loss": ("gear", "rolling_loss", "W/m"),
    "bearing_rolling_loss": ("bearing", "rolling_loss", "W/m"),
}
"""What is fitted: to which contacts, to which column, in which unit."""


def characterise_oil(
    oil: str | Path | Mapping[str, Any],
    folder: str | Path,
    *,
    size: int | None = None,
    bearing_size: int | None = None,
    seed: int = 0,
    ranges: Mapping[str, tuple[float, float]] | None = None,
    changes: Mapping[str, Any] | None = None,
    jobs: int | None = None,
    dask: str | None = None,
    cluster: str | None = None,
    progress: Progress | None = None,
) -> OilModel:
    """Simulate contacts of an oil, and fit friction and rolling loss to them.

    Parameters
    ----------
    oil : str, Path or mapping
        A name of the oil library, a TOML file with its properties, or these.
    folder : str or Path
        Keeps every finished simulation; what is there from an interrupted call is not done again.
        It gets the table ``simulations.csv`` and the models, ``model.json``.
    size, bearing_size : int, optional
        Numbers of gear and bearing contacts of a space-filling design; by default the full tables
        of Talbot (2012), or with `size` no bearing contacts.
    seed : int
        Of designs and profiles.
    ranges : mapping of str to (float, float), optional
        Other limits of gear contacts, ``{"hertz_pressure": (0.3, 1.6)}``, in display units.
    changes : mapping of str to object, optional
        Keys of a line contact that hold for all, ``{"lubricant.eyring_stress": "8 MPa"}``.
    jobs, dask
        As for `sweep`.
    cluster : str, optional
        Another name of `dask`.
    progress : callable, optional
        Called with the numbers of finished, of all, and of failed simulations.

    Returns
    -------
    OilModel

    Raises
    ------
    InputError
        If something given cannot be used, a file cannot be written, or the folder has another
        campaign.
    """
    campaign = make_campaign(
        oil, size=size, bearing_size=bearing_size, seed=seed, ranges=ranges, changes=changes
    )
    runner = Runner(jobs, dask or cluster, progress=progress)
    runner.check()
    place = CampaignFolder(Path(folder), campaign)
    place.prepare()
    place.run(runner)
    return fit_and_write(place)


def fit_and_write(folder: CampaignFolder) -> OilModel:
    """Fit, and write the models to the folder."""
    model = fit_campaign(folder)
    write_file(folder.model, model.to_text())
    return model


def fit_campaign(folder: CampaignFolder) -> OilModel:
    """Fit friction and rolling loss to all simulations that are good enough.

    Theory (O8).

    A simulation counts if nearly all of its time steps converged, its grid resolved the roughness,
    and what is fitted is known to 10 %, whether or not it reached the error at which it is called
    converged.

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
            remedy = "Simulate more, with a larger --size in another folder."
            reasons.append(Problem(quantity, given, f"not fitted: {error}.", remedy))
    if reasons:
        raise InputError(reasons, str(folder.path))
    frame, parts = folder.read(), QUANTITIES.values()
    return OilModel(
        format=FORMAT,
        version=campaign.version,
        settings=campaign.describe()["settings"],
        designs=tuple(campaign.describe()["designs"]),
        seed=campaign.seed,
        command=command_of(campaign),
        simulations={
            "simulated": len(frame),
            "not converged": int(frame["status"].eq("failed").sum()),
            "fitted": int(
                np.any([_good(frame, part, column) for part, column, _ in parts], axis=0).sum()
            ),
        },
        notes=("Errors are those against the simulations, not against measurements.",),
        equivalent_modulus=_modulus(folder),
        fits=fits,
    )


def simulated_quantities(
    folder: CampaignFolder,
) -> dict[str, tuple[LineContacts, FloatArray, FloatArray]]:
    """Conditions, value and weight of the simulations that are good enough, by quantity."""
    frame = folder.read()
    found = {}
    for quantity, (part, column, _) in QUANTITIES.items():
        if frame["part"].eq(part).any():
            rows = frame[_good(frame, part, column)]
            states = _states(rows, folder)
            found[quantity] = (states, rows[column].to_numpy(), _weights(rows, column))
    return found


def _good(frame: pd.DataFrame, part: str, column: str) -> pd.Series:
    """Which simulations of a part are known well enough to be fitted."""
    value, error = frame[column], frame[f"{column}_error"]
    solved = frame["part"].eq(part) & frame["unsolved_share"].le(LARGEST_UNSOLVED_SHARE)
    resolved = frame["roughness_kept"].ge(FEWEST_KEPT)
    return solved & resolved & value.gt(0) & error.le(LARGEST_ERROR * value)


def _modulus(folder: CampaignFolder) -> float:
    """E_eq of all simulations. [Pa]"""
    return contact_model(folder.campaign.case(0)).contact.equivalent_modulus


def _states(rows: pd.DataFrame, folder: CampaignFolder) -> LineContacts:
    """Conditions of some simulations, SI."""
    values: dict[str, FloatArray] = {}
    for name in AXES:
        scale, offset = quantity_of_axis(name).scale_and_offset()
        values[name] = (rows[column_of(name)].to_numpy(dtype=float) - offset) / scale
    oil = folder.campaign.case(0).lubricant.oil
    states = [oil_state(oil, float(temperature)) for temperature in values.pop("temperature")]
    return contacts_at(
        **values,
        dynamic_viscosity=np.array([state.dynamic_viscosity for state in states]),
        pressure_viscosity=np.array([state.pressure_viscosity for state in states]),
        equivalent_modulus=_modulus(folder),
    )


def _weights(rows: pd.DataFrame, column: str) -> FloatArray:
    """What each simulation counts: less where its mean is known less well."""
    error: FloatArray = (rows[f"{column}_error"] / rows[column]).to_numpy()
    weight: FloatArray = SCATTER**2 / (SCATTER**2 + error**2)
    return weight
