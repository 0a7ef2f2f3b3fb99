"""What the JSON form of a result holds, checked when it is read from a file."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import BaseModel, ConfigDict

__all__ = ["Measure", "Member", "ResultContents", "Validity"]


class _Part(BaseModel):
    """Unknown keys are those of a later version and are left alone."""

    model_config = ConfigDict(frozen=True, extra="ignore", allow_inf_nan=False)


class Measure(_Part):
    """A number with its unit; None where there is none."""

    value: float | None
    unit: str


class Measures(_Part):
    """Numbers of one unit."""

    value: tuple[float, ...]
    unit: str


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


class ResultContents(_Part):
    """The JSON form of a result, `epicyclic.Result.to_dict`."""

    title: str
    kind: Literal["planetary", "gear_pair"]
    status: str
    losses: dict[str, float]
    load_dependent: float
    load_independent: float
    total: float
    input_power: float
    efficiency: float | None
    warnings: tuple[str, ...]
    not_included: dict[str, str]
    factors: dict[str, float]
    methods: dict[str, str]
    groups: dict[str, str]
    citations: dict[str, str]
    models: dict[str, str]
    validity: tuple[Validity, ...]
    members: dict[str, Member]
    meshes: dict[str, dict[str, Measure]]
    fluid: dict[str, Measure]
    planet_bearing: dict[str, Measure] | None
    planet_angles: Measures
    planet_shares: Measures
    mesh_load_factor: Measure
    sources: tuple[str, ...]
    inputs: dict[str, Any]
    versions: dict[str, str]
