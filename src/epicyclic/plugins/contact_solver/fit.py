"""From the table of a campaign to the fitted models of an oil."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from epicyclic.arrays import FloatArray
from epicyclic.contact.fitted_models import (
    FORMAT,
    FORMS,
    REGIMES,
    FitError,
    FittedForm,
    Form,
    NearbySimulations,
    OilModel,
    QuantityFit,
    Regression,
    Structured,
    check_resistance,
)
from epicyclic.contact.line_contact import CONDITIONS, LineContacts, contacts_at
from epicyclic.errors import Problem, raise_any
from epicyclic.files import write_file
from epicyclic.oil.oil import oil_state
from epicyclic.plugins.contact_solver.campaign import (
    AXES,
    Campaign,
    CampaignFolder,
    column_of,
    command_of,
    make_campaign,
    quantity_of_axis,
)
from epicyclic.plugins.contact_solver.conditions import FEWEST_KEPT
from epicyclic.plugins.contact_solver.contact import contact_model
from epicyclic.plugins.contact_solver.rough import LARGEST_UNSOLVED_SHARE
from epicyclic.study.sweeps.runner import Progress, Runner

# Fits of all forms of a quantity, with errors at contacts that they had not seen.

BEYOND = 3  # Mean distances of the values of a condition by which its domain goes beyond them. [1]
FOLDS = 10  # Parts of the contacts, each of which is predicted from the others.
DIGITS = 12
"""Significant digits of coefficients and errors in a file: what is beyond them is rounding."""


def fit_quantity(
    quantity: str,  # A key of `FORMS`.
    unit: str,
    states: LineContacts,
    target: FloatArray,  # Simulated values above zero, and what each counts in the sum of squares.
    weight: FloatArray,  # Simulated values above zero, and what each counts in the sum of squares.
) -> QuantityFit:
    """Every form of a quantity. Theory (O8).

    Raises `ValueError` if no form can be fitted, with the reason.
    """
    fitted, left_out = [], {}
    domain = {name: _limits(getattr(states, name)) for name in CONDITIONS}
    for name, form in FORMS[quantity].items():
        try:
            coefficients = form.fit(states, target, weight)
            if isinstance(form, Regression):
                modulus = states.flanks.equivalent_modulus
                check_resistance(quantity, form, coefficients.tolist(), domain, modulus)
            alone, corrected = _cross_validated(form, states, target, weight)
            nearby = None
            if corrected.mean() < alone.mean():
                nearby = _nearby(form, coefficients, states, target, weight)
        except (ValueError, np.linalg.LinAlgError) as error:
            left_out[name] = str(error)
            continue
        fitted.append(
            FittedForm(
                form=name,
                coefficients=tuple(map(_rounded, coefficients)),
                errors=_errors_of(alone if nearby is None else corrected, states.film_ratio),
                nearby=nearby,
            )
        )
    if not fitted:
        raise ValueError("; ".join(f"{name}: {reason}" for name, reason in left_out.items()))
    return QuantityFit(
        unit=unit, contacts=target.size, domain=domain, forms=tuple(fitted), left_out=left_out
    )


def _cross_validated(
    form: Form, states: LineContacts, target: FloatArray, weight: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """|computed/simulated - 1| at each contact, fitted without its part: the form, and corrected.

    Regressions are as they are published: nothing corrects them.
    """
    part = np.random.default_rng(0).permutation(target.size) % FOLDS
    alone, corrected = np.empty(target.size), np.empty(target.size)
    for number in range(FOLDS):
        unseen = part == number
        if not unseen.any():
            continue
        seen = (states.taken(~unseen), target[~unseen], weight[~unseen])
        coefficients = form.fit(*seen)
        there = states.taken(unseen)
        alone[unseen] = corrected[unseen] = form.value(there, coefficients)
        if isinstance(form, Structured):
            corrected[unseen] *= _nearby(form, coefficients, *seen).factor(there)
    return np.abs(alone / target - 1), np.abs(corrected / target - 1)


def _nearby(
    form: Form,
    coefficients: FloatArray,
    states: LineContacts,
    target: FloatArray,
    weight: FloatArray,
) -> NearbySimulations:
    excess = np.log(target / form.value(states, coefficients))
    return NearbySimulations.of(states, excess, weight)


def _errors_of(error: FloatArray, film_ratio: FloatArray) -> tuple[FitError, ...]:
    """Errors in every range of film ratios that has contacts."""
    found = []
    for name, (low, high) in REGIMES.items():
        here = error[(film_ratio > low) & (film_ratio <= high)]
        if here.size:
            found.append(
                FitError(
                    regime=name,
                    contacts=here.size,
                    median=_rounded(np.median(here)),
                    largest_of_90_percent=_rounded(np.quantile(here, 0.9)),
                )
            )
    return tuple(found)


def _limits(values: FloatArray) -> tuple[float, float]:
    """What the values span, and some of their distances more: a design fills its range."""
    low, high = float(values.min()), float(values.max())
    beyond = min(BEYOND * (high - low) / values.size, low / 2)
    return _rounded(low - beyond), _rounded(high + beyond)


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")


LARGEST_ERROR = 0.10  # Standard error of a simulated mean over it above which it is not fitted. [1]
SCATTER = 0.05
"""Relative error that a form has anyway: smaller ones of a simulation do not count more. [1]"""
QUANTITIES = {
    "friction": ("gear", "friction", "1"),
    "rolling_loss": ("gear", "rolling_loss", "W/m"),
    "bearing_rolling_loss": ("bearing", "rolling_loss", "W/m"),
}
"""What is fitted: to which contacts, to which column, in which unit."""


_SHARED = {"settings": "with another oil or other settings", "version": "by another version"}
"""What campaigns that are fitted together share, and what is said where they differ."""


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
        Seed of designs and profiles.
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
    return fit_and_write([place], place.model)


def fit_and_write(folders: Sequence[CampaignFolder], output: Path) -> OilModel:
    """Fit, and write the models."""
    model = fit_campaigns(folders)
    write_file(output, model.to_text())
    return model


def fit_campaigns(
    # Campaigns of one oil, of one version and with the same settings.
    folders: Sequence[CampaignFolder],
) -> OilModel:
    """Fit friction and rolling loss to all simulations that are good enough. Theory (O8).

    A simulation counts if nearly all of its time steps converged, its grid resolved the roughness,
    and what is fitted is known to 10 %, whether or not it reached the error at which it is called
    converged. Raises `InputError` if there are too few of them, or campaigns differ in more than
    their points.
    """
    _check_alike(folders)
    campaigns = [folder.campaign for folder in folders]
    fits: dict[str, QuantityFit] = {}
    reasons = []
    for quantity, (states, target, weight) in simulated_quantities(folders).items():
        unit = QUANTITIES[quantity][2]
        try:
            fits[quantity] = fit_quantity(quantity, unit, states, target, weight)
        except ValueError as error:
            given = f"{target.size} simulations"
            remedy = "Simulate more contacts, with a larger --size in another folder."
            reasons.append(Problem(quantity, given, f"not fitted: {error}.", remedy))
    raise_any(reasons, str(folders[0].path))
    frame, parts = _read(folders), QUANTITIES.values()
    return OilModel(
        format=FORMAT,
        version=campaigns[0].version,
        settings=campaigns[0].describe()["settings"],
        designs=tuple(item for one in campaigns for item in one.describe()["designs"]),
        seed=campaigns[0].seed,
        command="; ".join(map(command_of, campaigns)),
        simulations={
            "simulated": len(frame),
            "not converged": int(frame["status"].eq("failed").sum()),
            "fitted": int(
                np.any([_good(frame, part, column) for part, column, _ in parts], axis=0).sum()
            ),
        },
        notes=("Errors are relative to the simulations, not to measurements.",),
        equivalent_modulus=_modulus(campaigns[0]),
        fits=fits,
    )


def simulated_quantities(
    folders: Sequence[CampaignFolder],
) -> dict[str, tuple[LineContacts, FloatArray, FloatArray]]:
    """Conditions, value and weight of the simulations that are good enough, by quantity."""
    frame = _read(folders)
    found = {}
    for quantity, (part, column, _) in QUANTITIES.items():
        if frame["part"].eq(part).any():
            rows = frame[_good(frame, part, column)]
            states = _states(rows, folders[0].campaign)
            found[quantity] = (states, rows[column].to_numpy(), _weights(rows, column))
    return found


def _check_alike(folders: Sequence[CampaignFolder]) -> None:
    """Refuse campaigns that differ in more than their points."""
    first, *others = folders
    wrong = [
        Problem(
            "DIR", str(other.path), f"was simulated {told} than {first.path}.",
            "Fit campaigns of the same oil, settings and version together.",
        )
        for other in others
        for name, told in _SHARED.items()
        if getattr(other.campaign, name) != getattr(first.campaign, name)
    ]  # fmt: skip
    raise_any(wrong, "the campaigns")


def _read(folders: Sequence[CampaignFolder]) -> pd.DataFrame:
    """The tables of all simulations, one after the other."""
    return pd.concat([folder.read() for folder in folders], ignore_index=True)


def _good(frame: pd.DataFrame, part: str, column: str) -> pd.Series:
    """Which simulations of a part are known well enough to be fitted."""
    value, error = frame[column], frame[f"{column}_error"]
    solved = frame["part"].eq(part) & frame["unsolved_share"].le(LARGEST_UNSOLVED_SHARE)
    resolved = frame["roughness_kept"].ge(FEWEST_KEPT)
    return solved & resolved & value.gt(0) & error.le(LARGEST_ERROR * value)


def _modulus(campaign: Campaign) -> float:
    """E_eq of all simulations. [Pa]"""
    return contact_model(campaign.case(0)).contact.equivalent_modulus


def _states(rows: pd.DataFrame, campaign: Campaign) -> LineContacts:
    """Conditions of some simulations, SI."""
    values: dict[str, FloatArray] = {}
    for name in AXES:
        scale, offset = quantity_of_axis(name).scale_and_offset()
        values[name] = (rows[column_of(name)].to_numpy(dtype=float) - offset) / scale
    oil = campaign.case(0).lubricant.oil
    states = [oil_state(oil, float(temperature)) for temperature in values.pop("temperature")]
    return contacts_at(
        **values,
        dynamic_viscosity=np.array([state.dynamic_viscosity for state in states]),
        pressure_viscosity=np.array([state.pressure_viscosity for state in states]),
        equivalent_modulus=_modulus(campaign),
    )


def _weights(rows: pd.DataFrame, column: str) -> FloatArray:
    """What each simulation counts: less where its mean is known less well."""
    error: FloatArray = (rows[f"{column}_error"] / rows[column]).to_numpy()
    weight: FloatArray = SCATTER**2 / (SCATTER**2 + error**2)
    return weight
