"""How well each model of friction and rolling loss is known to be right, and against what."""

from __future__ import annotations

from epicyclic.oilmodel.model import OilModel
from epicyclic.units import percent

_GEAR_TESTS = "fitted to gear tests, whose scatter was not found in print"
_OF_THE_CASE = "given by the case"
_NOT_KNOWN = "no comparison with measurements was found"
STANDING: dict[str, dict[str, str]] = {
    "friction": {
        "mixed-ehl": "regression of simulated contacts, its error against them not printed; with "
        "it the measured loss of the sets it was made for is predicted 3.5 % low in its slope at "
        "90 °C (Talbot 2012, Fig. 5.9), lower at 40 and 60 °C",
        "mixed-ehl+pairing": "mixed-ehl where both flanks are equally rough; the effect of a "
        "smoother one is that of the solver of this package, not compared with measurements",
        "xu-2007": "regression of simulated contacts; 24 to 36 % off the measured loss of one "
        "jet-lubricated spur pair (tests of Petry-Johnson et al., second hand)",
        "benedict-kelley": f"fitted to disc tests; {_NOT_KNOWN}",
        "matsumoto": f"film and dry friction are estimates of the case; {_NOT_KNOWN}",
        "doleschel": f"film and dry friction are estimates of the case; {_NOT_KNOWN}",
        "schlenk": _GEAR_TESTS,
        "niemann-winter": _GEAR_TESTS,
        "constant": _OF_THE_CASE,
        "table": _OF_THE_CASE,
        "ehl-direct": "contacts solved, the error of interpolation stated among the warnings; "
        "not compared with measurements",
    },
    "rolling": {
        "mixed-ehl": "its scale is a reconstruction, right within a factor of about 2 against "
        "smooth contacts (R4)",
        "mixed-ehl+pairing": "as mixed-ehl where both flanks are equally rough, the effect of a "
        "smoother one from the solver of this package",
        "goksem-hargreaves": "within some 15 % of solved smooth contacts without heating; rough "
        "contacts lose more",
    },
    "bearing": {
        "mixed-ehl": "calibrated on three printed losses of one bearing; a fourth, with smoother "
        "rollers, is met within 10 %",
        "palmgren": "its source gives a range of a factor of 2 for caged rollers",
    },
    "churning": {
        "changenet-velex": "fitted to tests of single gears, whose scatter was not found in print; "
        "readings of its slow regime in other works lie up to 40 % lower",
        "iso-14179-1": "coefficients of a standard, which states no error",
    },
    "shaft_bearing": {
        "skf-2018": "formulas of a catalogue, which states no error",
        "palmgren": "mean coefficients of bearings of a type, whose scatter was not found in print",
        "harris": "mean coefficients of bearings of a type, whose scatter was not found in print",
        "table": _OF_THE_CASE,
    },
}
"""By role and name of the model, each a phrase."""
FITTED = {"friction": "friction", "rolling": "rolling_loss", "bearing": "bearing_rolling_loss"}
"""Which quantity of a fit each role takes."""


def standing(
    role: str,  # ``"friction"``, ``"rolling"``, ``"bearing"`` of planets or ``"shaft_bearing"``.
    name: str,  # Name of the model, as a case chooses it.
    # The fitted models of the oil, for a name that begins with ``fitted``.
    model: OilModel | None = None,
    form: str = "",  # Which form of the fit; the first one if the file lacks it.
) -> str:
    """What is known of the error of a model, as a phrase.

    Examples
    --------
    >>> standing("rolling", "goksem-hargreaves").split(";")[0]
    'within some 15 % of solved smooth contacts without heating'
    """
    if not name.startswith("fitted"):
        return STANDING[role][name]
    assert model is not None
    fit = model.fits[FITTED[role]]
    fitted = next((item for item in fit.forms if item.form == form), fit.forms[0])
    whole = fitted.errors[0]
    known = (
        f"median error {percent(whole.median, 0)}, 90 % of contacts within "
        f"{percent(whole.largest_of_90_percent, 0)}, against {fit.contacts} contacts simulated for "
        f"{model.oil.name}, not against measurements"
    )
    _, beyond, formula = name.partition("-or-")
    return f"{known}; beyond them {formula}: {STANDING[role][formula]}" if beyond else known
