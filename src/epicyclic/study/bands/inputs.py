"""All that is uncertain in a case: what it states itself, and what is assumed otherwise."""

from __future__ import annotations

from fnmatch import fnmatchcase
from functools import cache
from typing import Any

from epicyclic import library
from epicyclic.case.case import CaseTable
from epicyclic.case.gear_tables import GearTable
from epicyclic.case.keys import Parameter, known_keys, parameter_of, value_of
from epicyclic.case.tables.operation import FACTOR_KEY
from epicyclic.case.tables.uncertainty import (
    MODEL_FORM,
    DistributionTable,
    UncertainValue,
    has_effect,
    made_value,
    model_forms,
    stated_values,
)
from epicyclic.dataclass import dataclass
from epicyclic.errors import Problem
from epicyclic.gears.stated import tolerances_of
from epicyclic.messages import dotted, key_parts
from epicyclic.units import MICROMETRE

_MICROMETRE = 1e-6


@dataclass(frozen=True, slots=True)
class Assumption:
    """A distribution that is assumed where a case states none."""

    keys: tuple[str, ...]  # Patterns of keys.
    table: DistributionTable
    source: str

    def holds_for(self, key: str) -> bool:
        """Whether a key is one of those."""
        return any(fnmatchcase(key, pattern) for pattern in self.keys)


_ABOUT = ("keys", "source", "name", "advice")


def remedy_for(key: str) -> tuple[str, str]:
    """What a value is called where it limits the trust in a result, and what to do then."""
    table = library.uncertainty_table()
    for entry in (*table["inputs"], *table["elsewhere"]):
        if any(fnmatchcase(key, pattern) for pattern in entry["keys"]):
            return entry["name"].format(key=key), entry["advice"].format(key=key)
    for entry in table["model_form"]:
        if key == f"{MODEL_FORM}{entry['kind']}":
            return entry["name"], entry["advice"]
    return key, "state it in [uncertainty] once it is measured"


@cache
def _assumptions() -> tuple[Assumption, ...]:
    return tuple(
        Assumption(
            tuple(entry["keys"]),
            DistributionTable.model_validate(
                {key: value for key, value in entry.items() if key not in _ABOUT}
            ),
            entry["source"],
        )
        for entry in library.uncertainty_table()["inputs"]
    )


def model_form_of(term: str, method: str = "") -> str:
    """The kind of losses that share the error of a model, of a loss: ``"sliding"``."""
    for entry in library.uncertainty_table()["model_form"]:
        known = any(fnmatchcase(term, pattern) for pattern in entry["terms"])
        if known and fnmatchcase(method, entry.get("method", "*")):
            return str(entry["kind"])
    return "other"


def factors_of_kind(case: CaseTable, kind: str) -> dict[str, float]:
    """Keys of the factors of all losses of a kind that a case computes, with their values."""
    entries = library.uncertainty_table()["model_form"]
    patterns = [one for entry in entries if entry["kind"] == kind for one in entry["terms"]]
    found = {}
    for key in known_keys(case):
        owner, _, name = key.rpartition(".")
        table, _, term = owner.rpartition(".")
        is_loss = name == "factor" and table.rpartition(".")[2] == "losses"
        of_kind = is_loss and any(fnmatchcase(term, one) for one in patterns)
        if of_kind and value_of(case, f"{owner}.include"):
            found[key] = float(value_of(case, key))
    return found


def uncertain_values(
    case: CaseTable,
    kinds: tuple[str, ...] = (),  # Kinds of losses that it has, see `model_form_of`.
) -> tuple[tuple[UncertainValue, ...], list[Problem]]:
    """All that is uncertain in a case, and what is wrong with its table [uncertainty]."""
    known = set(known_keys(case))
    found, problems = stated_values(case)
    own = getattr(case, "uncertainty", {})
    for key in sorted(known - own.keys()):
        found[key] = _assumed(case, key)
    for kind in kinds:
        key = f"{MODEL_FORM}{kind}"
        if key not in own and kind in model_forms():
            factor, source = model_forms()[kind]
            found[key] = UncertainValue(key, "", 1.0, "lognormal", (factor,), 0.0, source=source)
    values = tuple(
        value
        for key, value in found.items()
        if value is not None and (key.removeprefix(MODEL_FORM) in kinds or key in known)
    )
    return values, problems


def _assumed(case: CaseTable, key: str) -> UncertainValue | None:
    if not has_effect(case, key) or not _is_shared(case, key) or _is_inherited(case, key):
        return None
    limit = slope_limit(case, key)
    if limit is not None:
        return _assumed_slope(case, key, limit)
    assumption = _assumption(case, key)
    parameter = None if assumption is None else parameter_of(case, key)
    if assumption is None or not isinstance(parameter, Parameter):
        return None
    made = made_value(case, parameter, assumption.table, assumption.source)
    return made if isinstance(made, UncertainValue) else None


def _is_shared(case: CaseTable, key: str) -> bool:
    """False for the sharing of load between planets of which there are no two."""
    *owner, table, _ = ("", *key_parts(key))
    return table != "load_sharing" or (case.gearings[owner[-1]].count or 1) > 1


def _is_inherited(case: CaseTable, key: str) -> bool:
    """True for a model parameter of a set that does not state it: that of the train counts."""
    parts = key_parts(key)
    if len(parts) != 4 or (parts[0], parts[2]) != ("sets", "models"):
        return False
    models: Any = value_of(case, dotted(parts[:3]))
    return parts[3] not in models.model_fields_set


def _assumed_slope(case: CaseTable, key: str, limit: float) -> UncertainValue:
    """The slope of a flank, anywhere within its tolerance."""
    value = (value_of(case, key) or 0.0) / _MICROMETRE
    spread = limit / _MICROMETRE
    source = "tolerance of the accuracy class, ISO 1328-1:2013; all values within it equally likely"
    return UncertainValue(
        key, MICROMETRE.display, value, "uniform", (value - spread, value + spread), source=source
    )


def _assumption(case: CaseTable, key: str) -> Assumption | None:
    """What is assumed of a key; of a share of oil by the method from which it follows."""
    if not key.endswith(FACTOR_KEY):
        return next((it for it in _assumptions() if it.holds_for(key)), None)
    method = library.named("lubrication")[value_of(case, key.rpartition(".")[0]).method]
    table = DistributionTable(lognormal_factor=method["lognormal_factor"])
    return Assumption((key,), table, method["source"])


SLOPES = {"profile_slope": "profile_slope", "lead_slope": "helix_slope"}
"""Keys of ``micro_geometry``, and what ISO 1328-1 calls their tolerance."""
_FLANKS = ("micro_geometry", "micro_geometry_ring_side")
_TAKES_DEVIATIONS = "compliance"  # The load distribution to which slopes matter.


def slope_limit(case: CaseTable, key: str) -> float | None:
    """Tolerance f_HalphaT or f_HbetaT of the slope that `key` states; None where it has none.

    None also where the load distribution does not see slopes, and of the flank that works against
    the ring unless the case has a table of it: else it has the slope of the other one. [m]
    """
    parts = key_parts(key)
    if len(parts) < 3 or parts[-1] not in SLOPES or parts[-2] not in _FLANKS:
        return None
    *owner, name = parts[:-2]
    table = value_of(case, dotted([*owner, name]))
    if not isinstance(table, GearTable) or table.accuracy_class is None:
        return None
    if parts[-2] != _FLANKS[0] and getattr(table, parts[-2], None) is None:
        return None
    of_set: Any = case  # a set or pair by itself, in a train, or with listed gears
    if owner:
        of_set = value_of(case, dotted(owner[:2]))
    if of_set.models.load_distribution != _TAKES_DEVIATIONS:
        return None
    tolerances = tolerances_of(case.gearings[owner[1] if owner else ""].gear(name), table)
    return float(getattr(tolerances, SLOPES[parts[-1]]))
