"""How oil gets to the gears of a set, and what follows from it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from epicyclic.units import known_text


@dataclass(frozen=True, slots=True)
class OilSupply:
    """The share of oil around the gears of a set, and their churning.

    Attributes
    ----------
    method : str
        ``"dip"``.
    share, low, high : float
        Share of oil by volume, and the ends of its 95 % band. [1]
    grade : str
        ``"given"``, ``"read"`` or ``"estimate"``.
    source : str
    churning : mapping of str to float
        What parts that dip lose after each model; empty if none dips. [W]
    meshes : mapping of str to float
        Share of oil in the pockets of each mesh. [1]
    """

    method: str
    share: float
    low: float
    high: float
    grade: str
    source: str
    churning: Mapping[str, float] = field(default_factory=dict[str, float])
    meshes: Mapping[str, float] = field(default_factory=dict[str, float])

    @property
    def text(self) -> str:
        """In words, for a list of models and how well they are known."""
        if self.grade == "given":
            return f"{self.method}: share of oil {self.share:.2g}, given by {self.source}"
        band = f"95 %: {self.low:.2g} to {self.high:.2g}"
        fed = max(self.meshes.values(), default=0.0) - self.share
        more = f"; up to {fed:.2g} more in the meshes" if fed > 0 else ""
        return f"{self.method}: share of oil {self.share:.2g} ({band}; {self.source}){more}"

    @property
    def comparison(self) -> str:
        """Churning after each model in words; empty if nothing dips."""
        return ", ".join(f"{name} {known_text(watts)}" for name, watts in self.churning.items())

    def to_dict(self) -> dict[str, Any]:
        """As plain numbers and text."""
        return {
            "method": self.method,
            "oil_share": {
                "value": self.share,
                "low": self.low,
                "high": self.high,
                "unit": "1",
                "grade": self.grade,
                "source": self.source,
            },
            "oil_share_in_meshes": {
                name: {"value": share, "unit": "1"} for name, share in self.meshes.items()
            },
            "churning": {name: {"value": w, "unit": "W"} for name, w in self.churning.items()},
        }
