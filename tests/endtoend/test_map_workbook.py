"""The Excel workbook of a map: numbers in formats, in colours, and drawn."""

from __future__ import annotations

import openpyxl
import pytest

import epicyclic as ep


def test_each_temperature_has_a_sheet_of_speed_by_torque(tmp_path):
    case = ep.load_case("talbot-2012-pair").updated({"losses.mesh_pocketing.include": False})
    data = ep.loss_map(
        case,
        speed=["300 rpm", "900 rpm", "2100 rpm"],
        torque=["-20 N*m", "0 N*m", "35 N*m", "80 N*m"],
        temperature=["40 degC", "75 degC"],
        jobs=1,
    )
    ep.write_map(data, tmp_path / "map.xlsx")
    book = openpyxl.load_workbook(tmp_path / "map.xlsx")
    assert book.sheetnames == ["map", "oil at 40 °C", "oil at 75 °C", "inputs", "about"]
    torques = [float(value) for value in data["torque"]]
    for celsius in (40, 75):
        sheet = book[f"oil at {celsius} °C"]
        own = data.sel(temperature=celsius)
        blocks = {"total": (2, "0.0"), "efficiency": (8, "0.00%")}
        for name, (first, style) in blocks.items():
            assert [cell.value for cell in sheet[first]][1:5] == torques
            for line, speed in enumerate(own["speed"].values, first + 1):
                assert sheet.cell(line, 1).value == speed
                for column, torque in enumerate(torques, 2):
                    cell = sheet.cell(line, column)
                    value = float(own[name].sel(speed=speed, torque=torque))
                    if value != value:
                        assert cell.value is None
                        continue
                    assert cell.value == pytest.approx(value, rel=1e-12)
                    assert cell.number_format == style
        ranges = [str(one.sqref) for one in sheet.conditional_formatting]
        assert ranges == ["B3:E5", "B9:E11"]
        (chart,) = sheet._charts
        assert len(chart.series) == 3
        assert chart.series[2].yVal.numRef.f == f"'oil at {celsius} °C'!$B$5:$E$5"
        assert chart.series[2].tx.strRef.f == f"'oil at {celsius} °C'!$A$5"


def test_a_distance_gives_the_loss_for_it(tmp_path):
    case = ep.load_case("talbot-2012-pair").updated({"losses.mesh_pocketing.include": False})
    data = ep.loss_map(case, ["0 rpm", "900 rpm"], ["0 N*m", "60 N*m"], jobs=1)
    cycle = {"speed [rpm]": [300, 800], "torque [N*m]": [20, 50], "duration [s]": [40, 75]}
    result = ep.duty_cycle(data, cycle, distance="1.7 km", samples=1)
    lost = float(result["energy_lost"].sum())
    assert float(result["lost_per_distance"]) == pytest.approx(lost / 3.6 / 1.7)
    assert result["lost_per_distance"].attrs["units"] == "Wh/km"
    with pytest.raises(ep.InputError, match='distance = "5 kg": has a unit that measures'):
        ep.duty_cycle(data, cycle, distance="5 kg", samples=1)
    from epicyclic.show.studies import _in_other_units

    text = _in_other_units(result)
    assert f"{lost / 3600:.4g} kWh, {1e3 * lost / 115:.4g} W on average" in text
    assert "Wh/km over 1.7 km." in text
