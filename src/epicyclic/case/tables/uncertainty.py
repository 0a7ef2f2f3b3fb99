"""The table [uncertainty]: how well the values of a case are known."""

from __future__ import annotations

from typing import Any, ClassVar

from pydantic import Field

from epicyclic.case.tables.base import Table
from epicyclic.units import Number

Stated = str | Number
"""A value of the key as a case file has it, or a percentage of it; its unit is that of the key."""


class DistributionTable(Table):
    """How well one value is known: by one of the keys down to `exact`."""

    EXACTLY_ONE: ClassVar[tuple[tuple[str, ...], ...]] = (
        ("normal", "uniform", "tolerance", "lognormal_factor", "exact"),
    )

    normal: Stated | None = Field(
        default=None,
        description='Standard uncertainty about the value, "0.05 um" or "12 %".',
    )
    uniform: tuple[Stated, Stated] | None = Field(
        default=None, description="Limits between which all values are alike."
    )
    tolerance: tuple[Stated, Stated] | None = Field(
        default=None,
        description="Limits as deviations from the value, between which all are alike.",
    )
    lognormal_factor: Number | None = Field(
        default=None,
        gt=1,
        description="Two thirds of all values lie between the value over and times this factor.",
    )
    exact: bool | None = Field(default=None, description="true: known, against the default.")
    correlated: dict[str, Number] = Field(
        default={},
        description="Coefficients of correlation with other keys of this table, -1 to 1.",
    )

    def __hash__(self) -> int:  # a table of names cannot be hashed
        return hash((self.normal, self.uniform, self.tolerance, self.lognormal_factor))


UNCERTAINTY: Any = Field(
    default={},
    description="How well values are known, by their keys, and models, by model_form.KIND.",
)
"""The field of a case."""
