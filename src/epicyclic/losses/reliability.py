"""How well each loss model is known to be right, and against what."""

from __future__ import annotations

from collections.abc import Mapping

from epicyclic.contact.fitted_models import OilModel
from epicyclic.losses.drag import CHURNING_MODELS
from epicyclic.losses.friction import FRICTION_MODELS
from epicyclic.losses.planet_bearing import BEARING_RELIABILITY
from epicyclic.losses.ranges import FITTED_QUANTITIES
from epicyclic.losses.rolling import CONTAINED, ROLLING_MODELS
from epicyclic.losses.shaft_bearing import SHAFT_BEARING_RELIABILITY
from epicyclic.units import percent

RELIABILITY: Mapping[str, Mapping[str, str]] = {
    "friction": {
        **{name: model.reliability for name, model in FRICTION_MODELS.items()},
        "ehl-direct": "contacts are solved, and the warnings state the interpolation error; not "
        "compared with measurements",
    },
    "rolling": {it.name: it.reliability for it in (*ROLLING_MODELS.values(), CONTAINED)},
    "bearing": BEARING_RELIABILITY,
    "churning": {name: model.reliability for name, model in CHURNING_MODELS.items()},
    "shaft_bearing": SHAFT_BEARING_RELIABILITY,
}
"""By role and name of the model, each a phrase."""


def reliability(
    role: str,  # ``"friction"``, ``"rolling"``, ``"bearing"`` of planets or ``"shaft_bearing"``.
    name: str,  # Name of the model, as a case chooses it.
    # The fitted models of the oil, for a name that begins with ``fitted``.
    model: OilModel | None = None,
    form: str = "",  # Which form of the fit; the first one if the file lacks it.
) -> str:
    """What is known of the error of a model, as a phrase.

    Examples
    --------
    >>> reliability("rolling", "goksem-hargreaves").split(";")[0]
    'within about 15 % of solved smooth contacts without heating'
    """
    if not name.startswith("fitted"):
        return RELIABILITY[role][name]
    assert model is not None
    fit = model.fits[FITTED_QUANTITIES[role]]
    whole = next((item for item in fit.forms if item.form == form), fit.forms[0]).errors[0]
    known = (
        f"median error {percent(whole.median, 0)}, 90 % of contacts within "
        f"{percent(whole.largest_of_90_percent, 0)}, against {fit.contacts} contacts simulated for "
        f"{model.oil.name}, not against measurements"
    )
    _, beyond, formula = name.partition("-or-")
    return f"{known}; beyond them {formula}: {RELIABILITY[role][formula]}" if beyond else known
