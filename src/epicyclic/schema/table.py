"""The classes of tables of a file: frozen, without unknown keys, with values over axes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Any, ClassVar, TypeVar

from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag

from epicyclic.schema.fields import to_inputs


def option(description: str | None, default: Any = None, **limits: Any) -> Any:
    """The field of a key with a default, which is stated as a file has it, with its unit."""
    return Field(default=default, description=description, **limits)


class Table(BaseModel):
    """Base of all tables: immutable, no unknown keys.

    ``EXACTLY_ONE`` lists groups of alternatives of which a file gives exactly one; an alternative
    of several keys, joined by ``+``, needs all of them. Of the groups in ``AT_MOST_ONE`` a file may
    give none. A change of one key of a group replaces the others; so it does in the groups of
    ``REPLACING``, of which checks across keys tell what a file states twice.

    ``STAND_INS`` are keys on which no check across tables depends. If such a key cannot be used,
    the checks go on with the value given here (None: with the default).

    ``SHOWN_BY`` is the command that shows the keys of a whole file.
    """

    model_config = ConfigDict(
        frozen=True,
        extra="forbid",
        validate_default=True,
        allow_inf_nan=False,
        defer_build=True,  # a case of one kind builds no tables of the others
    )
    EXACTLY_ONE: ClassVar[tuple[tuple[str, ...], ...]] = ()
    AT_MOST_ONE: ClassVar[tuple[tuple[str, ...], ...]] = ()
    REPLACING: ClassVar[tuple[tuple[str, ...], ...]] = ()
    STAND_INS: ClassVar[dict[str, object]] = {}
    SHOWN_BY: ClassVar[str] = "'epicyclic init'"

    def __repr_args__(self) -> Iterable[tuple[str, Any]]:
        """Keys with their values as a file has them, with units."""
        return to_inputs(self).items()

    def __dir__(self) -> list[str]:
        """Keys, and what this package adds to them: not what Pydantic does."""
        own = {name for name in super().__dir__() if not name.startswith("_") and name.islower()}
        return sorted(own - set(dir(BaseModel)) | set(type(self).model_fields))


class PointsTable(Table):
    """Base of tables with values over some of the ``AXES``."""

    AXES: ClassVar[tuple[str, ...]]

    def axes(self) -> dict[str, tuple[float, ...]]:
        """The axes given, by name."""
        given = {name: getattr(self, name) for name in self.AXES}
        return {name: points for name, points in given.items() if points is not None}


def _values_or_rows(value: object) -> str:
    """Which of its two forms a list of numbers has."""
    rows = isinstance(value, list | tuple) and any(isinstance(row, list | tuple) for row in value)
    return "rows" if rows else "values"


Item = TypeVar("Item")
ValuesOrRows = Annotated[
    Annotated[tuple[Item, ...], Tag("values")]
    | Annotated[tuple[tuple[Item, ...], ...], Tag("rows")],
    Discriminator(_values_or_rows),
]
"""A value, or a row of them, for each point of the first axis of a table."""
