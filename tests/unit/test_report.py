"""Numbers and units as tables show them."""

from __future__ import annotations

import math
import re
import tomllib

import pytest

import epicyclic as ep
from epicyclic.show.page import error_text, shown
from epicyclic.show.result_tables import mesh_tables
from epicyclic.show.template import case_template
from epicyclic.units import unit_text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (1234.56, "1235"),
        (0.001234, "0.001234"),
        (-0.0, "0"),
        (3e-14, "0"),
        (-3e-14, "0"),
        (math.nan, "-"),
    ],
)
def test_rounding_noise_is_zero_and_nan_is_a_dash(value, text):
    assert shown(value) == text


@pytest.mark.parametrize(
    ("unit", "text"),
    [("1", ""), ("N*m", "N·m"), ("mm^2/s", "mm²/s"), ("kg/m^3", "kg/m³"), ("degC", "°C")],
)
def test_units_in_print(unit, text):
    assert unit_text(unit) == text


NEEDY = ("[thrust_bearing]", "[planet_pin]", "[seals.NAME]", "[lubrication]", "[friction_table]")
"""Tables with keys that have no defaults."""


def uncommented(text):
    """A template with every default that it shows, without the tables that need more than that."""
    text = re.sub(r"^# (?=\[|[\w.]+ = )", "", text, flags=re.MULTILINE)
    sections = re.split(r"^(?=\[)", text, flags=re.MULTILINE)
    kept = [one for one in sections if not one.startswith(NEEDY)]
    lines = "".join(kept).splitlines(keepends=True)
    return "".join(line for line in lines if "..." not in line and not line.startswith("housing."))


@pytest.mark.parametrize("kind", ["planetary", "gear_pair"])
def test_template_with_its_defaults_uncommented_is_the_same_case(kind):
    template = case_template(kind)
    plain, full = (tomllib.loads(text) for text in (template, uncommented(template)))
    assert set(full) - set(plain) >= {"contact_solver", "numerics", "losses"}
    one, other = map(ep.load_case, (plain, full))
    assert one.inputs().keys() <= other.inputs().keys()
    assert ep.solve(one).losses == ep.solve(other).losses


def test_template_shows_how_arrays_nest():
    shown_as = dict(re.findall(r"^# (\S+) = (\[.*\]) *#", case_template("planetary"), re.MULTILINE))
    assert shown_as["angles"] == '["... deg", ...]'
    assert shown_as["micro_geometry.topography.diameter"] == '["... mm", ...]'
    for flank in ("micro_geometry", "micro_geometry_ring_side"):
        assert shown_as[f"{flank}.topography.deviation"] == '[["... um", ...], ...]'


@pytest.mark.parametrize(
    ("share", "told"),
    [(2.69e-5, "under 0.01 %"), (-3e-5, "under 0.01 %"), (0.0123, "1.23 %"), (math.nan, "-")],
)
def test_errors_of_balances_are_told_in_percent(share, told):
    assert error_text(share) == told


def test_figures_of_meshes_tell_how_well_pockets_are_computed_where_that_is_known(talbot_record):
    told = {
        row[0].text: [cell.text for cell in row[1:-1]]
        for table in mesh_tables(talbot_record.result)
        for row in table.rows
    }
    assert told["pocketing loss: error of its energy balance"] == ["under 0.01 %"] * 2
    assert "largest interpolation error of the pocketing loss" not in told  # all are solved
