"""Results as users have them: with tables, pictures, files and a page of a notebook.

What makes these is imported when it is asked for: solving alone loads neither pandas nor
Matplotlib.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Self, cast

from epicyclic.case.case import Case
from epicyclic.dataclass import dataclass, fields, replace
from epicyclic.errors import one_problem
from epicyclic.files import check_place, write_file
from epicyclic.losses.pocket_tables import FlowTables
from epicyclic.result import result as plain
from epicyclic.study import heat
from epicyclic.study import solve as study
from epicyclic.study.load import CaseSource, as_case
from epicyclic.study.operating import operating_line

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from epicyclic.show.record import ResultRecord

FILES = (".nc", ".json", ".html", ".pdf")


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Result(plain.Result):
    __doc__ = plain.Result.__doc__

    @classmethod
    def of(cls, solved: plain.Result) -> Self:
        """What was solved, with views."""
        return cls(**{it.name: getattr(solved, it.name) for it in fields(solved)})

    def table(
        self,
        # ``"losses"``: power, share of the total, group and method of every loss and sum.
        # ``"numbers"``: value, unit and label of every number, as sweeps store them.
        of: str = "losses",
    ) -> pd.DataFrame:
        """Losses, or every number, as a table.

        One row for each, named by its key.

        Examples
        --------
        >>> import epicyclic as ep
        >>> result = ep.solve(ep.load_case("talbot-2012"))
        >>> table = result.table()
        >>> bool(table.loc["total", "loss [W]"] == result.total)
        True
        """
        import pandas as pd

        if of == "numbers":
            rows = [(it.key, it.value, it.unit, it.label) for it in self.numbers()]
            return pd.DataFrame(rows, columns=["key", "value", "unit", "label"]).set_index("key")
        if of != "losses":
            allowed = 'must be "losses" or "numbers".'
            raise one_problem("of", f'"{of}"', allowed, "Choose one.", "the table")
        terms = [(it.name, it.watts, it.group, it.left_out or it.method) for it in self.terms]
        sums = ("load_dependent", "load_independent", "total")
        terms += [(name, getattr(self, name), "sum", "") for name in sums]
        columns = ["key", "loss [W]", "group", "method"]
        losses = pd.DataFrame(terms, columns=columns).set_index("key")
        share = losses["loss [W]"] / self.total if self.total else float("nan")
        losses.insert(1, "share of the total", share)
        return losses

    def plot(
        self,
        # Its name, ``"power-flow"``; an unknown one is answered with those that there are.
        what: str = "losses",
        *,
        # Width and height; default: those of a slide. [mm]
        size: tuple[float, float] | None = None,
        # Pixels an inch; default: such that the picture is as wide as a slide of 1920 pixels.
        dpi: float | None = None,
    ) -> Figure:
        """One of the pictures of ``epicyclic plot``.

        Its ``savefig`` writes a file.

        Examples
        --------
        >>> import epicyclic as ep
        >>> figure = ep.solve(ep.load_case("talbot-2012")).plot("losses", size=(120, 80))
        """
        from epicyclic.show.plots.catalogue import figure_of

        return figure_of(_record_of(self), what, size=size, dpi=dpi)

    def save(
        self,
        # ``.nc``: everything, for `open_result`, reports and plots; ``.json``: the numbers;
        # ``.html`` or ``.pdf``: the report.
        path: str | Path,
    ) -> None:
        """Keep the result in a file, whole or not at all.

        Raises `InputError` if there is no place for the file, or it ends otherwise.

        Examples
        --------
        >>> import tempfile
        >>> import epicyclic as ep
        >>> result = ep.solve(ep.load_case("talbot-2012"))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     result.save(f"{folder}/result.json")
        """
        save(self, Path(path))

    def _repr_html_(self) -> str:
        """Operating point, key figures, losses, warnings."""
        from epicyclic.show.html import items_html
        from epicyclic.show.result_tables import key_figures
        from epicyclic.show.summary import first_lists, loss_summary

        figures = (f"{it.label} {it.text}" for it in key_figures(self))
        lines = (operating_line(self.inputs["operation"]), ", ".join(figures))
        title = escape(self.title or self.kind.replace("_", " "))
        head = f"<p><strong>{title}</strong><br>{'<br>'.join(map(escape, lines))}</p>"
        return f"<div>{head}{items_html(loss_summary(self), *first_lists(self, None))}</div>"


def save(result: plain.Result, path: Path) -> None:
    """`Result.save`, of any result."""
    from epicyclic.show.html import check_pdf, page_bytes, report_html
    from epicyclic.show.record import save_result

    if path.suffix not in FILES:
        allowed = f"must end in {', '.join(FILES)}."
        raise one_problem("path", str(path), allowed, "Name such a file.", "the result")
    check_place(path)
    if path.suffix == ".pdf":
        check_pdf()
    if path.suffix == ".nc":
        save_result(_record_of(result), path)
        return
    text = result.to_json() + "\n" if path.suffix == ".json" else report_html(_record_of(result))
    write_file(path, page_bytes(text, path.suffix))


@lru_cache(maxsize=4)
def _record_of(result: plain.Result) -> ResultRecord:
    """The fields behind a result, which take longer than the result: several pictures need them."""
    from epicyclic.show.record import record

    return record(cast(Case, result.case), result=result)


def solve(case: CaseSource, *, flow_tables: FlowTables | None = None) -> Result:
    """Compute the losses of a case.

    Parameters
    ----------
    case : PlanetaryCase, GearPairCase, TrainCase, str, Path or mapping
        From `load_case`, or what that reads: a file, the name of a built-in case, tables.
    flow_tables : mapping, optional
        Tables of flows through pockets, as `sweep` makes them for its points; flows that they do
        not hold are solved.

    Returns
    -------
    Result
        Its status is ``unphysical`` if a loss is negative, the energy does not balance, or loads or
        resistances exceed any physical limit; the first of its warnings says why.

    Raises
    ------
    ConvergenceError
        If an iteration ends without a solution, or a loss is not a finite number.
    """
    return Result.of(study.solve(as_case(case), flow_tables=flow_tables))


def solve_for(
    case: CaseSource,
    quantity: str,
    temperature: str | float,
    *,
    progress: Callable[[int, int], object] | None = None,
) -> heat.Found:
    """The cooling power, oil flow or input power that gives an oil temperature.

    Parameters
    ----------
    case : PlanetaryCase, GearPairCase or TrainCase
    quantity : str
        ``"cooler_power"``: heat that a cooler takes from the oil; ``"oil_flow"``: oil that leaves
        and comes back at the inlet temperature; ``"input_power"``: torque at the given speed.
    temperature : str or float
        Temperature of the oil in the gearbox: text with a unit, or in kelvin.
    progress : callable, optional
        Called with the numbers of steady states found and expected.

    Raises
    ------
    InputError
        If no value of the quantity leads to that temperature.

    Examples
    --------
    >>> import epicyclic as ep
    >>> case = ep.load_case("talbot-2012-pair", {
    ...     "operation.torque": "100 N*m", "operation.speed": "2000 rpm"})
    >>> found = ep.solve_for(case, "oil_flow", "110 degC")
    >>> round(found.result.heat.oil - 273.15, 4)
    110.0
    """
    found = heat.solve_for(as_case(case), quantity, temperature, progress=progress)
    return replace(found, result=Result.of(found.result))
