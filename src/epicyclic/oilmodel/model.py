"""The file of the models fitted for an oil: it says what was simulated, what fits, and how well."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping, Sequence
from functools import cached_property, lru_cache
from importlib import metadata
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator, model_validator

from epicyclic.contact import CONDITIONS, LineContacts, contacts_at
from epicyclic.errors import InputError, Problem
from epicyclic.lubricant.oil import Oil
from epicyclic.oilmodel.nearby import NearbySimulations
from epicyclic.oilmodel.regressions import (
    FRICTION_REGRESSION,
    NEEDLE_REGRESSION,
    ROLLING_REGRESSION,
    Regression,
)
from epicyclic.oilmodel.structured import STRUCTURED_FRICTION, STRUCTURED_ROLLING, Structured
from epicyclic.text_file import read_text, sealed, unsealed

FloatArray = NDArray[np.float64]
Form = Regression | Structured

FORMAT: Literal["epicyclic oil model 4"] = "epicyclic oil model 4"
"""Name and version of the file format."""
FORMS: dict[str, dict[str, Form]] = {
    "friction": {form.name: form for form in (STRUCTURED_FRICTION, FRICTION_REGRESSION)},
    "rolling_loss": {form.name: form for form in (STRUCTURED_ROLLING, ROLLING_REGRESSION)},
    "bearing_rolling_loss": {form.name: form for form in (STRUCTURED_ROLLING, NEEDLE_REGRESSION)},
}
"""Forms of every quantity by name, the one that is used by default first."""
REGIMES: dict[str, tuple[float, float]] = {
    "all": (0.0, np.inf),
    "film ratio up to 0.7": (0.0, 0.7),
    "film ratio 0.7 to 3": (0.7, 3.0),
    "film ratio above 3": (3.0, np.inf),
}
"""Ranges of the film ratio for which errors are stated. [1]"""
LARGEST_FILE = 5_000_000
"""A file of coefficients is much smaller. [bytes]"""


_OF_THE_FILM = {"rolling_speed": False, "roughness1": True, "roughness2": True}
"""Conditions that make films thick, and whether they do so by falling."""
_MAY_BE_ZERO = ("slide_to_roll_ratio", "roughness1", "roughness2")


def _parts(version: str) -> list[int]:
    return [int(part) for part in version.split(".")]


class _Data(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class FitError(_Data):
    """Errors of contacts that the fit had not seen, |computed/simulated - 1|. Theory (O8).

    Attributes
    ----------
    regime : str
        One of `REGIMES`.
    contacts : int
    median, largest_of_90_percent : float
        [1]
    """

    regime: str
    contacts: int = Field(ge=0)
    median: float = Field(ge=0)
    largest_of_90_percent: float = Field(ge=0)


class FittedForm(_Data):
    """Coefficients of a form, its correction, and its cross-validated errors.

    Attributes
    ----------
    form : str
    coefficients : tuple of float
    errors : tuple of FitError
        With the correction, if there is one.
    nearby : NearbySimulations, optional
        What corrects a structured form.
    """

    form: str
    coefficients: tuple[float, ...]
    errors: tuple[FitError, ...]
    nearby: NearbySimulations | None = None


class QuantityFit(_Data):
    """What was fitted to one quantity.

    Attributes
    ----------
    unit : str
    contacts : int
        Simulations behind it.
    domain : dict of str to (float, float)
        Lowest and highest value of every condition among them, SI.
    forms : tuple of FittedForm
        The one that is used by default first.
    left_out : dict of str to str
        Forms that could not be fitted, and why.
    """

    unit: str
    contacts: int = Field(ge=1)
    domain: dict[str, tuple[float, float]]
    forms: tuple[FittedForm, ...] = Field(min_length=1)
    left_out: dict[str, str] = {}

    @model_validator(mode="after")
    def _check_domain(self) -> QuantityFit:
        if set(self.domain) != set(CONDITIONS):
            raise ValueError(f"the domain must have {', '.join(CONDITIONS)}")
        for name, (low, high) in self.domain.items():
            if not 0 <= low <= high or (low == 0 and name not in _MAY_BE_ZERO):
                raise ValueError(f"the domain of {name} must rise, above zero: {low:g} to {high:g}")
        return self


class OilModel(_Data):
    """Friction and rolling loss of an oil.

    Attributes
    ----------
    format : str
        `FORMAT`.
    version : str
        Version of this package, which solved the contacts.
    settings : dict
        Tables of a line contact that all simulations shared; the oil is one of them.
    designs : list
        The simulated points.
    seed : int
        Seed of the profiles; of several campaigns that of the first one.
    command : str
        Command that makes the simulations; of several campaigns one after the other.
    simulations : dict of str to int
        How many were simulated, failed, and were fitted.
    notes : tuple of str
        What to know before using it.
    equivalent_modulus : float
        E_eq of the simulations. [Pa]
    fits : dict of str to QuantityFit
        By quantity, the keys of `FORMS`.
    """

    format: Literal["epicyclic oil model 4"]
    version: str
    settings: dict[str, Any]
    designs: tuple[dict[str, Any], ...]
    seed: int
    command: str = ""
    simulations: dict[str, int]
    notes: tuple[str, ...] = ()
    equivalent_modulus: float = Field(gt=0)
    fits: dict[str, QuantityFit]

    def __hash__(self) -> int:
        # of a few fields: all of them take longer than what is looked up by it
        return hash((self.version, self.seed, self.command, self.equivalent_modulus))

    @model_validator(mode="after")
    def _check_fits(self) -> OilModel:
        try:
            _ = self.oil
        except (KeyError, TypeError) as error:
            raise ValueError("the settings have no oil") from error
        for quantity, fit in self.fits.items():
            known = FORMS.get(quantity)
            if known is None:
                raise ValueError(f"no quantity {quantity}")
            for fitted in fit.forms:
                form = known.get(fitted.form)
                if form is None or form.size != len(fitted.coefficients):
                    raise ValueError(f"{quantity}: wrong coefficients of form {fitted.form}")
                if isinstance(form, Structured) and not form.allows(fitted.coefficients):
                    raise ValueError(f"{quantity}: {fitted.form} coefficients out of bounds")
                if isinstance(form, Regression):
                    check_resistance(
                        quantity, form, fitted.coefficients, fit.domain, self.equivalent_modulus
                    )
        return self

    @field_validator("version")
    @classmethod
    def _check_version(cls, version: str) -> str:
        own = metadata.version("epicyclic")
        if not re.fullmatch(r"\d+(\.\d+)*", version) or _parts(version) > _parts(own):
            raise ValueError(f"made by version {version[:40]}; this is {own}")
        return version

    def to_text(self) -> str:
        """What its file holds."""
        return sealed(self.model_dump(mode="json"), indent=2)

    @cached_property
    def oil(self) -> Oil:
        """The oil that was simulated."""
        return Oil.model_validate(self.settings["lubricant"]["oil"])

    def value(
        self,
        quantity: str,  # A key of `fits`.
        states: LineContacts,
        form: str = "",  # By default the first one of the file.
    ) -> FloatArray:
        """A quantity at every contact, conditions held in the domain. Theory (O2)."""
        fit = self.fits[quantity]
        fitted = next((item for item in fit.forms if item.form == form), fit.forms[0])
        coefficients = np.array(fitted.coefficients)
        limits = dict(fit.domain)
        if fitted.form == STRUCTURED_FRICTION.name and quantity == "friction":
            # (O5) goes on to no sliding
            limits["slide_to_roll_ratio"] = (0.0, limits["slide_to_roll_ratio"][1])
        held = states.held(limits)
        value = FORMS[quantity][fitted.form].value(held, coefficients)
        if fitted.nearby is not None:
            value = value * fitted.nearby.factor(held)
        return value


def check_resistance(
    quantity: str,
    form: Form,
    coefficients: Sequence[float],
    domain: Mapping[str, tuple[float, float]],
    equivalent_modulus: float,
) -> None:
    """Raise `ValueError` unless friction and losses are above zero and below what the load can do.

    In thin, middling and thick films of the domain. Coefficients themselves have no natural size,
    those of products of groups up to 1e10.
    """
    middle = {name: math.sqrt(low * high) or high / 2 for name, (low, high) in domain.items()}
    conditions = {name: np.full(3, value) for name, value in middle.items()}
    for name, falling in _OF_THE_FILM.items():
        low, high = domain[name][0] or middle[name], domain[name][1]
        conditions[name][::2] = (high, low) if falling else (low, high)
    with np.errstate(all="ignore"):  # what is no number is refused
        states = contacts_at(**conditions, equivalent_modulus=equivalent_modulus)
        shares = form.value(states, np.array(coefficients))
        if quantity != "friction":  # a loss
            shares = shares / (states.line_load * states.rolling_speed)
    worst = shares[np.argmax(np.abs(np.nan_to_num(shares, nan=np.inf) - 0.5))]
    if not 0 < worst <= 1:
        raise ValueError(
            f"{quantity}: {form.name} coefficients give {worst:.3g} times the load as resistance "
            "within the domain, which must be above 0 and at most 1"
        )


def read_oil_model(path: str | Path) -> OilModel:
    """The models in a file.

    Raises
    ------
    InputError
        If there is no such file, or it is not one of these, or damaged.
    """
    file = Path(path)
    try:
        stat = file.stat()
        return _read(file.absolute(), stat.st_mtime_ns, stat.st_size)
    except OSError as error:
        raise _file_error(file, f"cannot be read: {error.strerror}.") from None


@lru_cache(maxsize=16)
def _read(path: Path, _changed: int, _size: int) -> OilModel:
    """The file as it was when it was last changed."""
    try:
        content = unsealed(read_text(path, "oil model", LARGEST_FILE))
        return OilModel.model_validate_json(json.dumps(content))
    except InputError as error:
        raise _file_error(path, error.problems[0].allowed) from None
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        place = ".".join(map(str, first["loc"]))
        where = f" at {place}" if place else ""
        raise _file_error(path, f"is no sound oil model{where}: {first['msg']}.") from None


def _file_error(path: Path, allowed: str) -> InputError:
    remedy = "Give a model.json of 'epicyclic oil characterise' of this version."
    return InputError([Problem("models.oil_model", str(path), allowed, remedy)], str(path))
