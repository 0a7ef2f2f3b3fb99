"""A result from its JSON form, checked."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any, Literal

from epicyclic.dataclass import dataclass, replace
from epicyclic.errors import Status
from epicyclic.gears.gear import HOUSING
from epicyclic.losses.ranges import OUT_OF_RANGE, ValidityFlag
from epicyclic.machine.element import OIL, FluidFigures, Note, PartFigures, note_watts
from epicyclic.machine.gear_mesh import MeshFigures
from epicyclic.machine.planets import BearingFigures
from epicyclic.result.codec import Reader
from epicyclic.result.result import (
    HeatBalance,
    Layout,
    LossTerm,
    MemberState,
    OilSupply,
    PowerFlow,
    Result,
    Train,
)
from epicyclic.units import DEGREE, NUMBER, RPM, WATT

Numbers = Mapping[str, float]
Texts = Mapping[str, str]
_FORM = {
    "title": str,
    "kind": Literal["planetary", "gear_pair", "train"],
    "status": Literal["converged", "failed", "unphysical"],
    "losses": Numbers,
    "load_dependent": float,
    "load_independent": float,
    "total": float,
    "input_power": float,
    "efficiency": float | None,
    "warnings": tuple[str, ...],
    "not_included": Texts,
    "factors": Numbers,
    "methods": Texts,
    "groups": Mapping[str, Literal["load-dependent", "load-independent"]],
    "citations": Texts,
    "models": Texts,
    "validity": tuple[ValidityFlag, ...],
    "members": Mapping[str, MemberState],
    "meshes": Mapping[str, MeshFigures],
    "fluid": FluidFigures | None,
    "sources": tuple[str, ...],
    "inputs": Mapping[str, Any],
    "versions": Texts,
}
"""What every result states."""
_MORE: dict[str, tuple[Any, Any]] = {
    "standing": (Texts, {}),
    "heat": (HeatBalance | None, None),
    "planet_bearing": (BearingFigures | None, None),
    "bearings": (Mapping[str, BearingFigures], {}),
    "parts": (Mapping[str, PartFigures], {}),
    "note_watts": (Numbers, {}),
    "model_shares": (Mapping[str, Numbers], {}),
}
"""What only some state, and what it is for the others."""
_AS_READ = (
    *("title", "kind", "meshes", "parts", "fluid", "models", "standing", "sources", "versions"),
    *("planet_angles", "planet_shares", "train", "heat", "lubrication"),
)
"""Keys of which a result has an attribute."""
_Check = Callable[[Mapping[str, Any]], str]


@dataclass(frozen=True, slots=True)
class StatedCase:
    """The case of a result that was read: its inputs alone."""

    stated: Mapping[str, Any]

    def inputs(self) -> Mapping[str, Any]:
        """The case, defaults included, as a case file has it."""
        return self.stated


def stated_result(result: Result) -> dict[str, Any]:
    """What `read_result` reads: also the losses that notes concern, and the shares of models."""
    known = {note: note_watts(note) for note in result.notes}
    finite = {str(note): watts for note, watts in known.items() if math.isfinite(watts)}
    shares = {term.name: dict(term.shares) for term in result.terms if term.shares}
    return {**result.to_dict(), "note_watts": finite, "model_shares": shares}


def read_result(
    data: Any,  # As `stated_result` or `Result.to_dict` returns it.
    check_inputs: _Check = lambda inputs: "",  # What is wrong with the inputs, in words.
) -> tuple[Result | None, list[tuple[str, str]]]:
    """The result, or None and where `data` is none with what is wrong there."""
    reader = Reader()
    if not isinstance(data, dict):
        return None, [("", "Input should be a valid dictionary")]
    found = {}
    for key, kind in _FORM.items():
        if key in data:
            found[key] = reader.read(kind, data[key], key)
        else:
            reader.refuse(key, "Field required")
    for key, (kind, default) in _MORE.items():
        found[key] = reader.read(kind, data[key], key) if key in data else default
    found["train"] = reader.read(Train, data, "") if data.get("kind") == "train" else None
    for key, unit in (("planet_angles", DEGREE), ("planet_shares", NUMBER)):
        angles = data.get(key)
        found[key] = reader.read(tuple[float, ...], angles, key, unit) if angles else ()
    found["lubrication"] = _supplies(data.get("lubrication", {}), reader)
    if not reader.problems:
        if wrong := check_inputs(found["inputs"]):
            reader.refuse("inputs", wrong)
        if "epicyclic" not in found["versions"]:
            reader.refuse("versions", "must name the version of epicyclic")
    if not reader.problems:
        for place, wrong in _contradictions(found, data):
            reader.refuse(place, wrong)
    return (None if reader.problems else _made(found, data)), reader.problems


def _contradictions(found: Mapping[str, Any], data: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """What does not belong together."""
    if not found["members"]:
        yield "members", "Dictionary should have at least 1 item after validation, not 0"
    if found["losses"].keys() != found["groups"].keys():
        yield "", "losses and groups name different losses"
    if len(found["planet_angles"]) != len(found["planet_shares"]):
        yield "", "planet_angles and planet_shares count different planets"
    heat: HeatBalance | None = found["heat"]
    if heat is not None:
        if heat.model not in ("flank", "network"):
            yield "heat.model", "must be 'flank' or 'network'"
        if OIL not in {**heat.temperatures, **heat.given}:
            yield "heat", "the temperature of the oil is missing"
        if not {path.hot for path in heat.ways} <= heat.temperatures.keys():
            yield "heat", "heat paths name parts without temperatures"
    train: Train | None = found["train"]
    if train is None:
        if found["fluid"] is None or data.get("mesh_load_factor") is None:
            yield "", "fluid or mesh_load_factor is missing"
        return
    named = {train.input, train.output}
    named |= {shaft for clutch in train.clutches for shaft in clutch.split("+")}
    named |= {shaft for taken in train.stages.values() for shaft in taken}
    unknown = named - found["members"].keys() - {HOUSING}
    if unknown:
        yield "", f"members lacks {', '.join(sorted(unknown))}"
    shafts = found["inputs"].get("shafts", {})
    if not isinstance(shafts, dict) or not all(
        isinstance(names, list) and all(isinstance(name, str) for name in names)
        for names in shafts.values()
    ):
        yield "", "inputs.shafts must be lists of members"


def _made(found: dict[str, Any], data: Mapping[str, Any]) -> Result:
    losses, methods, citations = found["losses"], found["methods"], found["citations"]
    train: Train | None = found["train"]
    bearing = found["planet_bearing"]
    bearings = found["bearings"] if bearing is None else {"planet_bearing": bearing}
    heat: HeatBalance | None = found["heat"]
    models = found["inputs"].get("models")
    tested = isinstance(models, Mapping) and models.get("load_dependent") == "as-tested"
    notes = (text for text in found["warnings"] if not text.startswith(OUT_OF_RANGE))
    known = found["note_watts"]
    return Result(
        **{name: found[name] for name in _AS_READ},
        layout=Layout(
            losses=tuple(losses),
            members=tuple(found["members"]),
            meshes=tuple(found["meshes"]),
            bearings=tuple(bearings),
            shares=bool(found["planet_shares"]),
            rolling=() if train is None else tuple(train.rolling),
            parts=tuple((key, type(part)) for key, part in found["parts"].items()),
            fluid=found["fluid"] is not None,
            nodes=() if heat is None else tuple(heat.temperatures),
        ),
        terms=tuple(
            LossTerm(
                name,
                watts,
                found["groups"][name],
                methods.get(name, ""),
                citations.get(name, ""),
                found["factors"].get(name, 1.0),
                found["not_included"].get(name, ""),
                found["model_shares"].get(name, {}),
            )
            for name, watts in losses.items()
        ),
        flow=PowerFlow(
            {name: _member(data["members"][name], it) for name, it in found["members"].items()},
            found["input_power"],
            found["efficiency"],
        ),
        bearings=bearings,
        flags=found["validity"],
        notes=tuple(Note(text, known[text]) if text in known else text for text in notes),
        load_methods={key: text for key, text in methods.items() if key not in losses},
        load_sources={key: text for key, text in citations.items() if key not in losses},
        case=StatedCase(found["inputs"]),
        status=Status(found["status"]),
        unloaded=found["load_independent"] if tested else None,
    )


def _member(stated: Mapping[str, Any], member: MemberState) -> MemberState:
    """The member with that one of its speeds, alike but for rounding, that has its power."""
    power = stated.get("power")
    watts = power.get("value") if isinstance(power, dict) else None
    if not isinstance(watts, float) or not member.torque:
        return member
    near = watts / member.torque
    speeds = (near, math.nextafter(near, math.inf), math.nextafter(near, -math.inf))
    exact = (replace(member, speed=speed) for speed in speeds)
    shown = RPM.to_display(member.speed)
    return next(
        (it for it in exact if it.power == watts and RPM.to_display(it.speed) == shown), member
    )


def _supplies(stated: Any, reader: Reader) -> dict[str, OilSupply]:
    """Of a single set, or of the sets of a train by their names."""
    found = {}
    try:
        for name, own in ({"": stated} if "method" in stated else stated).items():
            share = own["oil_share"]
            found[name] = OilSupply(
                method=own["method"],
                share=share["value"],
                low=share["low"],
                high=share["high"],
                grade=share["grade"],
                source=share["source"],
                churning=reader.read(Numbers, own["churning"], "lubrication.churning", WATT),
                meshes=reader.read(Numbers, own["oil_share_in_meshes"], "lubrication", NUMBER),
            )
    except (AttributeError, KeyError, TypeError):
        reader.refuse("lubrication", "is not an oil supply")
    return found
