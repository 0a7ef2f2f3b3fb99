"""What cases and results show of themselves: lines, notebook pages, tables, pictures, files."""

from __future__ import annotations

import json

import pytest

import epicyclic as ep
from epicyclic.show.plots.catalogue import MM_PER_INCH
from epicyclic.show.summary import MOST_WARNINGS


@pytest.fixture(scope="module")
def case():
    return ep.load_case("talbot-2012", {"title": "A <set> & more", "operation.torque": "733 N*m"})


@pytest.fixture(scope="module")
def result(case):
    return ep.solve(case)


def test_a_case_says_its_operating_point_with_units(case):
    assert repr(case).startswith("PlanetaryCase(title='A <set> & more', ")
    assert "torque='733 N*m'" in repr(case)
    assert "helix_angle='13.124 deg'" in repr(case.gears)
    assert str(case) == repr(case)


def test_a_case_as_a_page_has_the_given_keys_and_no_markup_of_the_user(case):
    page = case._repr_html_()
    assert "A &lt;set&gt; &amp; more" in page
    assert "733 N·m" in page
    given = [key for table in case.given().values() if isinstance(table, dict) for key in table]
    assert all(f">{key}" in page for key in given)


def test_names_of_a_case_are_its_own(case):
    names = dir(case)
    assert {"sun", "planet_bearing", "updated", "given"} <= set(names)
    foreign = ("model_dump", "copy", "json", "schema", "EXACTLY_ONE", "_tables")
    assert not set(names) & set(foreign)
    assert set(type(case.gears).model_fields) <= set(dir(case.gears))
    assert not set(dir(case.gears)) & set(foreign)
    assert dir(ep) == sorted(ep.__all__)


def test_a_result_in_one_line(result):
    assert repr(result) == (
        f"<Result 'A <set> & more': total loss {result.total:.0f} W of "
        f"{result.input_power / 1e3:.0f} kW, efficiency {100 * result.efficiency:.3f} %, "
        f"{len(result.warnings)} warnings>"
    )


def test_a_result_as_a_page_has_losses_and_warnings(result):
    page = result._repr_html_()
    assert "A &lt;set&gt; &amp; more" in page
    assert f"{result.losses['sun_mesh_sliding']:.0f}</data>" in page
    missing = len(set(result.not_included.values()))
    assert missing < page.count("<li>") <= missing + MOST_WARNINGS


def test_a_train_as_a_page():
    assert "P1" in ep.solve(ep.load_case("train-8hp70"))._repr_html_()


def test_tables_of_a_result(result):
    losses = result.table()
    assert losses["loss [W]"].to_dict() == {
        **result.losses,
        "load_dependent": result.load_dependent,
        "load_independent": result.load_independent,
        "total": result.total,
    }
    share = losses.loc["sun_mesh_rolling", "share of the total"]
    assert share == result.losses["sun_mesh_rolling"] / result.total
    numbers = result.table("numbers")
    assert numbers.loc["sun_mesh_film_ratio_min", "value"] == (
        result.meshes["sun_mesh"].film_ratio_min
    )
    assert numbers.loc["sun_speed", "unit"] == "rpm"
    with pytest.raises(ep.InputError, match='must be "losses" or "numbers"'):
        result.table("gears")


def test_pictures_of_a_result_have_the_size_that_is_asked_for(result):
    slide = result.plot("losses")
    assert slide.get_size_inches()[0] * slide.dpi == pytest.approx(1920)
    assert slide.get_size_inches()[1] * slide.dpi == pytest.approx(1080, rel=1e-3)
    small = result.plot("loss-sum", size=(120, 70), dpi=77)
    assert tuple(small.get_size_inches() * MM_PER_INCH) == pytest.approx((120, 70))
    assert small.dpi == 77
    with pytest.raises(ep.InputError, match=r"is not a plot; it has .*losses"):
        result.plot("colours")


@pytest.mark.slow
def test_files_of_a_result(result, tmp_path):
    result.save(tmp_path / "kept.nc")
    assert ep.open_result(tmp_path / "kept.nc").result.total == result.total
    result.save(tmp_path / "kept.json")
    assert json.loads((tmp_path / "kept.json").read_text()) == json.loads(result.to_json())
    result.save(tmp_path / "kept.html")
    assert (tmp_path / "kept.html").read_text().startswith("<!DOCTYPE html>")
    with pytest.raises(ep.InputError, match=r"must end in \.nc, \.json, \.html, \.pdf"):
        result.save(tmp_path / "kept.docx")
    with pytest.raises(ep.InputError, match="lies in a folder that does not exist"):
        result.save(tmp_path / "nowhere" / "kept.json")
    assert len(list(tmp_path.iterdir())) == 3


def test_a_stored_result_in_one_line(talbot_record):
    assert repr(talbot_record).startswith(f"<ResultRecord {talbot_record.title!r}: total loss ")
    assert len(repr(talbot_record)) < 400


def test_a_planet_branch_and_the_load_dependent_efficiency(result):
    """Talbot (2012), Eq. 5.14: by its parts, and a third of six less three planets."""
    losses, branch = result.losses, result.branch
    spin = [
        name for name in losses if name.endswith(("pocketing", "bearing_viscous", "planets_drag"))
    ]
    spin.remove("thrust_bearing_viscous")
    assert branch.load_independent == pytest.approx(sum(losses[name] for name in spin) / 3)
    assert branch.load_dependent == pytest.approx(result.load_dependent / 3)
    assert branch.power == pytest.approx(result.input_power / 3)
    expected = 1 - branch.load_dependent / branch.power
    assert result.load_dependent_efficiency == pytest.approx(expected)
    assert result.efficiency < expected < 1
    six = ep.solve(result.case.updated({"planet.count": 6}))
    difference = six.load_independent - result.load_independent
    assert difference / 3 == pytest.approx(branch.load_independent, rel=1e-2)
    kept = {it.key: it.value for it in result.numbers()}
    assert kept["branch_load_independent"] == pytest.approx(branch.load_independent)
    assert kept["load_dependent_efficiency"] == pytest.approx(expected)
    stored = json.loads(result.to_json())
    assert stored["branch"]["power"]["value"] == pytest.approx(branch.power)


def test_a_pair_and_a_train_have_no_branch():
    for name in ("talbot-2012-pair", "train-8hp70"):
        found = ep.solve(ep.load_case(name))
        assert found.branch is None
        assert not any(it.key.startswith("branch_") for it in found.numbers())
