"""What the JSON form of a result holds, checked when it is read from a file."""

from __future__ import annotations

import math
from datetime import datetime
from typing import Annotated, Any, Literal, Self, get_args

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, model_validator
from pydantic_core import from_json

from epicyclic.gears.gear import HOUSING
from epicyclic.machine.element import OIL
from epicyclic.results.heat import HeatBalance, HeatWay
from epicyclic.results.result import Result
from epicyclic.study.operating import AXES
from epicyclic.units import CELSIUS


class _Part(BaseModel):
    """Unknown keys, of a later version, are kept."""

    model_config = ConfigDict(frozen=True, extra="allow", allow_inf_nan=False)


class Measure(_Part):
    """A number with its unit; None where there is none."""

    value: float | None
    unit: str


class Measures(_Part):
    """Numbers of one unit."""

    value: tuple[float, ...]
    unit: str


def _from_text(text: object) -> object:
    """What JSON text holds; `ValueError` if it is none, or nested too deep."""
    return from_json(str(text))


def _with_operation(inputs: dict[str, Any]) -> dict[str, Any]:
    """The inputs of a case, if they name its kind and state its operating point as text."""
    if inputs.get("kind") not in get_args(Kind):
        raise ValueError("must name the kind of the case")
    operation = inputs.get("operation")
    needed = _OPERATION_OF_TRAIN if inputs["kind"] == "train" else _OPERATION
    if not isinstance(operation, dict) or not all(
        isinstance(operation.get(key), str) for key in needed
    ):
        raise ValueError(f"must state operation with {', '.join(needed)}")
    return inputs


def _with_own(versions: dict[str, str]) -> dict[str, str]:
    if "epicyclic" not in versions:
        raise ValueError("must name the version of epicyclic")
    return versions


Kind = Literal["planetary", "gear_pair", "train"]
Group = Literal["load-dependent", "load-independent"]
Inputs = Annotated[dict[str, Any], AfterValidator(_with_operation)]
Versions = Annotated[dict[str, str], AfterValidator(_with_own)]
_OPERATION = tuple(key.rpartition(".")[2] for key in AXES.values())
_OPERATION_OF_TRAIN = ("speed", "torque", "input", "output")


class Member(_Part):
    """Speed, torque and power of a shaft."""

    speed: Measure
    torque: Measure
    power: Measure


class Use(_Part):
    """A model and where it was used."""

    role: str
    model: str
    where: str
    instead: str = ""


class Validity(_Part):
    """A model used outside its range."""

    use: Use
    quantity: str
    found_low: float
    found_high: float
    low: float | None
    high: float | None
    unit: str
    share: float
    source: str


class Degrees(_Part):
    """A temperature."""

    value: float
    unit: Literal["degC"]

    @property
    def kelvin(self) -> float:
        """In SI. [K]"""
        scale, offset = CELSIUS.scale_and_offset()
        return (self.value - offset) / scale


class Way(_Part):
    """Heat from one part to another."""

    hot: str = Field(alias="from")
    into: str = Field(alias="to")
    heat: float
    conductance: float | None
    method: str
    source: str


class Heat(_Part):
    """Temperatures and the ways of the heat, `HeatBalance.to_dict`."""

    model: Literal["flank", "network"]
    temperatures: dict[str, Degrees]
    given: dict[str, Degrees]
    sources: dict[str, float]
    ways: dict[str, Way]
    residual: float
    evaluations: int

    @model_validator(mode="after")
    def _belong_together(self) -> Self:
        if OIL not in self.temperatures | self.given:
            raise ValueError("the temperature of the oil is missing")
        if not {way.hot for way in self.ways.values()} <= self.temperatures.keys():
            raise ValueError("ways name parts without temperatures")
        return self

    @property
    def balance(self) -> HeatBalance:
        """As the result had it."""
        return HeatBalance(
            model=self.model,
            temperatures={node: it.kelvin for node, it in self.temperatures.items()},
            sources=self.sources,
            ways=tuple(
                HeatWay(
                    key,
                    way.hot,
                    way.into,
                    math.nan if way.conductance is None else way.conductance,
                    way.heat,
                    way.method,
                    way.source,
                )
                for key, way in self.ways.items()
            ),
            given={node: it.kelvin for node, it in self.given.items()},
            residual=self.residual,
            evaluations=self.evaluations,
        )


class ResultContents(_Part):
    """The JSON form of a result, `epicyclic.Result.to_dict`.

    What only a single set or only a train states has a default.
    """

    title: str
    kind: Kind
    status: str
    losses: dict[str, float]
    load_dependent: float
    load_independent: float
    total: float
    input_power: float
    efficiency: float | None
    units: dict[str, str]
    warnings: tuple[str, ...]
    not_included: dict[str, str]
    factors: dict[str, float]
    methods: dict[str, str]
    groups: dict[str, Group]
    citations: dict[str, str]
    models: dict[str, str]
    standing: dict[str, str] = {}
    validity: tuple[Validity, ...]
    members: dict[str, Member] = Field(min_length=1)
    meshes: dict[str, dict[str, Measure]]
    fluid: dict[str, Measure] | None
    heat: Heat | None = None
    planet_bearing: dict[str, Measure] | None = None
    planet_angles: Measures = Measures(value=(), unit="deg")
    planet_shares: Measures = Measures(value=(), unit="1")
    mesh_load_factor: Measure | None = None
    state: str = ""
    input: str = ""
    output: str = ""
    ratio: float | None = None
    power_ratio: float | None = None
    self_locking: bool = False
    jammed: bool = False
    rolling_power: dict[str, float] = {}
    clutches: dict[str, float] = {}
    stage_torques: dict[str, dict[str, float]] = {}
    stages: dict[str, float] = {}
    bearings: dict[str, dict[str, Measure]] = {}
    parts: dict[str, dict[str, Measure]] = {}
    sources: tuple[str, ...]
    inputs: Inputs
    versions: Versions

    @model_validator(mode="after")
    def _belong_together(self) -> Self:
        if self.losses.keys() != self.groups.keys():
            raise ValueError("losses and groups name different losses")
        if len(self.planet_angles.value) != len(self.planet_shares.value):
            raise ValueError("planet_angles and planet_shares count different planets")
        if self.kind == "train":
            self._check_train()
        elif self.fluid is None or self.mesh_load_factor is None:
            raise ValueError("fluid or mesh_load_factor is missing")
        return self

    def _check_train(self) -> None:
        """Shafts that clutches, stages, input and output name must be there."""
        named = {self.input, self.output}
        named |= {shaft for clutch in self.clutches for shaft in clutch.split("+")}
        named |= {shaft for taken in self.stage_torques.values() for shaft in taken}
        unknown = named - self.members.keys() - {HOUSING}
        if unknown:
            raise ValueError(f"members lacks {', '.join(sorted(unknown))}")
        shafts = self.inputs.get("shafts", {})
        if not isinstance(shafts, dict) or not all(
            isinstance(names, list) and all(isinstance(name, str) for name in names)
            for names in shafts.values()
        ):
            raise ValueError("inputs.shafts must be lists of members")


def contents_of(result: Result) -> ResultContents:
    """A result as a file would keep it, so that what is made of either is the same."""
    return ResultContents.model_validate_json(result.to_json())


def set_of(key: str) -> str:
    """The set to which a mesh, gear or bearing belongs; empty if there is one set only."""
    return key.rpartition(".")[0]


class RecordContents(_Part):
    """Attributes of the file of a result."""

    created: datetime
    result: Annotated[ResultContents, BeforeValidator(_from_text)]
    given: Annotated[dict[str, Any], BeforeValidator(_from_text)]


class SweepContents(_Part):
    """Attributes of a sweep."""

    title: str
    source: str
    case: Annotated[Inputs, BeforeValidator(_from_text)]
    versions: Annotated[Versions, BeforeValidator(_from_text)]


class MapContents(SweepContents):
    """Attributes of a loss map."""

    reference_shaft: str
