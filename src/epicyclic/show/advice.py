"""What limits the trust in a result, in sentences."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from typing import Any

from epicyclic.case.tables.uncertainty import MODEL_FORM
from epicyclic.result.result import Result, in_words
from epicyclic.show.page import Listing
from epicyclic.study.bands.advice import Known, limits_of, measurements_of
from epicyclic.units import known_text, percent

MOST = 3  # Inputs and models that are named after a band.
LIMITS = "What limits the trust in it"
FEW = 2  # Limits that a short list names.
WORTH = 0.98  # Part of the band above which a measurement is not worth while. [1]


def band_texts(known: Known | None) -> list[str | Listing]:
    """How well a single result is known, and what limits that; nothing if all is exact."""
    if known is None:
        return []
    low, high = known.ends["total"]
    text = f"95 % band: total loss {known_text(low, high)}"
    low, high = (100 * end for end in known.ends["efficiency"])
    if math.isfinite(low):
        text += f", efficiency {low:.2f} to {high:.2f} %"
    drivers = ", ".join(
        f"{driver_name(key)} {percent(share, 0)}" for key, share in known.drivers[:MOST]
    )
    return [
        f"{text}; most of it from {drivers}. Assumed where [uncertainty] of the case says nothing: "
        "'epicyclic uncertainty' shows all.",
        Listing(tuple(advice_texts(known, brief=True)), LIMITS),
    ]


def advice_texts(known: Known, *, brief: bool = False) -> Iterator[str]:
    """Sentences on limits, on the measurement that helps most, and on models, in this order.

    With `brief` only the most important ones.
    """
    for limit in limits_of(known)[: FEW if brief else None]:
        width = known_text(limit.width, unit=known.unit, beside=known.width)
        yield f"{limit.name}: {width} of the band; {limit.advice}."
    yield from _measurements(known)
    if known.remarks:
        yield from [" ".join(known.remarks)] if brief else known.remarks


def _measurements(known: Known) -> Iterator[str]:
    """The part of the loss, and the input, whose measurement narrows the band most."""
    found = [it for it in measurements_of(known) if it.width < WORTH * known.width]
    best = [next((it for it in found if it.is_input is own), None) for own in (False, True)]
    parts = [
        f"{it.name} to {known_text(it.width, unit=known.unit, beside=known.width)}"
        for it in best
        if it is not None
    ]
    if parts:
        before = known_text(known.width, unit=known.unit)
        lead = "" if best[0] is not None else "of the inputs "
        text = "; of the inputs ".join(parts)
        yield f"Measured, this would narrow the band of {before} most: {lead}{text}."


def result_json(result: Result, known: Known | None) -> str:
    """A result as JSON with its band and what limits the trust in it, unless all is exact."""
    content = result.to_dict() | ({} if known is None else _known(known))
    return json.dumps(content, indent=2, allow_nan=False, ensure_ascii=False)


def _known(known: Known) -> dict[str, Any]:
    ends = {name: list(known.ends[name]) for name in ("total", "efficiency")}
    return {
        "band": {
            **{name: own if math.isfinite(own[0]) else None for name, own in ends.items()},
            "shares": dict(known.drivers),
        },
        "advice": {
            "limits": [
                {"name": it.name, "width": it.width, "advice": it.advice} for it in limits_of(known)
            ],
            "measurements": [{"name": it.name, "width": it.width} for it in measurements_of(known)],
            "remarks": list(known.remarks),
            "unit": known.unit,
        },
    }


def driver_name(key: str) -> str:
    """What an uncertain value is called."""
    if key.startswith(MODEL_FORM):
        return f"model of {in_words(key.removeprefix(MODEL_FORM)).replace('-', ' ')}"
    return key
