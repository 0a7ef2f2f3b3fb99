"""Characterising an oil as a user does: campaigns, interruptions, clusters, models in cases."""

from __future__ import annotations

import json
import random
import resource
import shutil
import signal
import subprocess
import sys
import time

import numpy as np
import pandas as pd
import pytest

import epicyclic as ep
from epicyclic.contact.fitted_models import read_oil_model
from epicyclic.losses.friction import CONTACT_PROGRESS, contact_progress
from epicyclic.plugins.contact_solver.campaign import CampaignFolder, make_campaign, open_folder
from epicyclic.plugins.contact_solver.fit import fit_campaigns, simulated_quantities
from epicyclic.study.sweeps.runner import Runner

# contacts that take a tenth of a second
RANGES = {
    "radius": (5.0, 6.0),
    "slide_to_roll_ratio": (0.3, 1.0),
    "temperature": (25.0, 60.0),
    "roughness1": (0.1, 0.2),
    "roughness2": (0.1, 0.2),
    "hertz_pressure": (1.0, 2.0),
    "rolling_speed": (8.0, 20.0),
}
UNITS = {"radius": "mm", "temperature": "degC", "roughness1": "um", "roughness2": "um",
         "hertz_pressure": "GPa", "rolling_speed": "m/s"}  # fmt: skip
SIZE = 16
COARSE = {"numerics.nodes": 128}
PAIR = {
    "operation.torque": "200 N*m",
    "operation.speed": "3000 rpm",
    "losses.mesh_pocketing.include": False,
}
FILES = ("simulations.csv", "model.json", "campaign.json")


def campaign():
    return make_campaign("atf-talbot-2012", size=SIZE, ranges=RANGES, changes=COARSE, seed=7)


def command(folder, *more):
    ranges = [
        part
        for name, (low, high) in RANGES.items()
        for part in ("--range", f"{name}={low}:{high} {UNITS.get(name, '')}".strip())
    ]
    return [
        sys.executable, "-m", "epicyclic", "oil", "characterise", "atf-talbot-2012",
        "--size", str(SIZE), "--seed", "7", "--set", "numerics.nodes=128", "-o", str(folder),
        *ranges, *more,
    ]  # fmt: skip


def content(folder):
    return {name: (folder / name).read_bytes() for name in FILES}


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A campaign that nothing disturbed, in one process."""
    folder = CampaignFolder(tmp_path_factory.mktemp("oil") / "atf", campaign())
    folder.prepare()
    folder.run(Runner(jobs=1))
    folder.model.write_text(fit_campaigns([folder]).to_text())
    return folder.path


def kept(folder):
    journal = folder / "simulations.partial"
    return journal.read_bytes().count(b'"row":') if journal.exists() else 0


def disturbed(folder, kills, seed):
    """The campaign with `kills` sudden deaths at random moments while it runs."""
    rng = random.Random(seed)
    for _ in range(kills):
        before = kept(folder)
        process = subprocess.Popen(
            command(folder), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        while process.poll() is None and kept(folder) == before:
            time.sleep(0.01)
        time.sleep(rng.uniform(0, 0.15))
        process.send_signal(signal.SIGKILL)
        process.wait()
    done = subprocess.run(command(folder), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.slow
@pytest.mark.parametrize("kills", [1, 10])
def test_a_killed_campaign_ends_with_the_same_bits(finished, tmp_path, kills):
    printed = disturbed(tmp_path / "atf", kills, seed=kills)
    assert content(tmp_path / "atf") == content(finished)
    assert sorted(path.name for path in (tmp_path / "atf").iterdir()) == sorted(FILES)
    assert "structured" in printed


@pytest.mark.slow
def test_a_cluster_gives_the_same_bits(finished, tmp_path):
    distributed = pytest.importorskip("distributed")
    folder = CampaignFolder(tmp_path / "atf", campaign())
    folder.prepare()
    counts: list[tuple[int, int, int]] = []
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=False, dashboard_address=":0"
    ) as cluster:
        address = cluster.scheduler_address
        folder.run(Runner(dask=address, progress=lambda *call: counts.append(call)))
    assert folder.table.read_bytes() == (finished / "simulations.csv").read_bytes()
    assert counts[-1][:2] == (SIZE, SIZE)


@pytest.mark.slow
def test_a_full_disk_loses_nothing(finished, tmp_path):
    folder = tmp_path / "atf"

    def small_files():
        # writing beyond it fails as on a full disk; compiled code is read, not written
        resource.setrlimit(resource.RLIMIT_FSIZE, (7000, resource.RLIM_INFINITY))

    stopped = subprocess.run(
        command(folder, "--jobs", "1"), capture_output=True, text=True, check=False,
        preexec_fn=small_files,
    )  # fmt: skip
    assert stopped.returncode == 2
    assert f"{SIZE} contacts, 0 of them already simulated" in stopped.stderr
    assert "simulations kept" in stopped.stderr
    assert "Traceback" not in stopped.stderr
    assert kept(folder) > 0
    assert not (folder / "simulations.csv").exists()
    before = kept(folder)
    done = subprocess.run(command(folder), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    counts = [f"{SIZE} contacts, {count} of them" for count in (before, before - 1)]
    assert any(count in done.stderr for count in counts)  # the last line may be cut short
    assert content(folder) == content(finished)


def test_an_unknown_scheduler_is_bad_input(tmp_path):
    pytest.importorskip("distributed")
    folder = CampaignFolder(tmp_path / "atf", campaign())
    folder.prepare()
    with pytest.raises(ep.InputError, match="cannot be reached"):
        folder.run(Runner(dask="nowhere"))


def test_the_table_states_every_condition_and_result(finished):
    import pandas as pd

    table = pd.read_csv(finished / "simulations.csv")
    assert list(table["number"]) == list(range(SIZE))
    assert {"temperature [degC]", "hertz_pressure [GPa]", "friction", "status"} <= set(table)
    assert table["friction"].between(0.001, 0.2).all()


def test_a_model_runs_in_a_case_and_flags_its_domain(finished):
    case = ep.load_case("talbot-2012-pair").updated(PAIR)
    fitted = {
        "models.friction": "fitted",
        "models.rolling": "fitted",
        "models.oil_model": str(finished / "model.json"),
    }
    result = ep.solve(case.updated(fitted))
    usual = ep.solve(case)
    assert 0 < result.losses["mesh_sliding"] != usual.losses["mesh_sliding"]
    assert 0 < result.losses["mesh_rolling"] != usual.losses["mesh_rolling"]
    assert any("the simulations of atf-talbot-2012" in text for text in result.warnings)
    other = ep.solve(case.updated(fitted | {"lubricant.oil": "iso-vg-100-mineral"}))
    assert any("was fitted for atf-talbot-2012" in note for note in other.notes)
    swept = ep.sweep(case.updated(fitted), {"operation.torque": ["100 N*m", "200 N*m"]})
    assert list(swept["status"].values) == ["converged", "converged"]


def test_a_case_finds_its_model_beside_it(finished, tmp_path):
    (tmp_path / "atf.json").write_bytes((finished / "model.json").read_bytes())
    case = ep.load_case("talbot-2012-pair").updated(PAIR)
    tables = case.inputs()
    tables["models"] |= {"friction": "fitted", "oil_model": "atf.json"}
    lines = _toml(tables)
    (tmp_path / "case.toml").write_text("\n".join(lines))
    assert ep.solve(ep.load_case(tmp_path / "case.toml")).losses["mesh_sliding"] > 0


def _toml(tables, path=""):
    """Tables as TOML; arrays of tables inline."""
    lines = [f"[{path}]"] if path else []
    for key, value in tables.items():
        if not isinstance(value, dict):
            lines.append(f"{key} = {_inline(value)}")
    for key, value in tables.items():
        if isinstance(value, dict):
            lines += _toml(value, f"{path}.{key}" if path else key)
    return lines


def _inline(value):
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {_inline(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(_inline, value)) + "]"
    return json.dumps(value)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"models.friction": "fitted", "lubricant.oil": "iso-vg-68-mineral"}, "needs a file"),
        ({"models.friction": "fitted", "models.oil_model": "none.json"}, "cannot be read"),
        ({"models.bearing": "fitted"}, "no bearing rolling loss"),
        ({"models.friction": "fitted", "models.fitted_form": "regression"}, "form regression"),
    ],
)
def test_a_model_that_lacks_what_is_asked_is_refused(finished, changes, told):
    case = ep.load_case("talbot-2012")
    if told.startswith(("no", "form")):
        changes = changes | {"models.oil_model": str(finished / "model.json")}
    with pytest.raises(ep.InputError, match=told):
        case.updated(changes)


@pytest.mark.slow
def test_show_and_fit_print_the_errors(finished, epicyclic):
    shown = epicyclic("oil", "show", str(finished / "model.json"))
    fitted = epicyclic("oil", "fit", str(finished))
    for done in (shown, fitted):
        assert done.returncode == 0, done.stderr
        for words in ("90 % below", "the default", "lubricant.eyring_stress", "Domain of"):
            assert words in done.stdout
    assert epicyclic("oil", "show", str(finished / "simulations.csv")).returncode == 2


@pytest.mark.slow
def test_campaigns_are_fitted_together(finished, epicyclic, tmp_path):
    def folder(name, **given):
        place = CampaignFolder(tmp_path / name, make_campaign("atf-talbot-2012", **given))
        place.prepare()
        place.run(Runner(jobs=1))
        return place.path

    wider = RANGES | {"radius": (7.0, 9.0)}
    more = folder("more", size=3, ranges=wider, changes=COARSE, seed=8)
    model = tmp_path / "model.json"
    done = epicyclic("oil", "fit", str(finished), str(more), "-o", str(model))
    assert done.returncode == 0, done.stderr
    together, alone = map(read_oil_model, (model, finished / "model.json"))
    assert together.simulations["simulated"] == SIZE + 3
    assert together.fits["friction"].contacts == alone.fits["friction"].contacts + 3
    assert together.fits["friction"].domain["radius"][1] > 7e-3
    assert [design["size"] for design in together.designs] == [SIZE, 3]
    assert together.command.count("epicyclic oil characterise") == 2

    assert epicyclic("oil", "fit", str(finished), str(more)).returncode == 2
    other = folder("other", size=1, ranges=RANGES, seed=7)
    refused = epicyclic("oil", "fit", str(finished), str(other), "-o", str(tmp_path / "no.json"))
    assert refused.returncode == 2
    assert "with another oil or other settings than" in refused.stderr
    assert not (tmp_path / "no.json").exists()


def test_contacts_of_a_mesh_are_solved_and_their_error_told(monkeypatch):
    # the friction of each contact stands in for a solution: a power of load and radius
    from epicyclic.plugins.contact_solver import direct

    calls = []

    def friction(line, roughness, seeds, heating, settings):
        calls.append(line)
        friction = np.nan if len(calls) == 3 else 0.05 * (line.radius / 0.01) ** 0.3
        return friction, 1.0

    monkeypatch.setattr(direct, "_friction", friction)
    case = ep.load_case("talbot-2012-pair").updated(PAIR | {"models.friction": "ehl-direct"})
    told = []
    with contact_progress(lambda *numbers: told.append(numbers)):
        result = ep.solve(case)
    assert [done for done, _ in told] == list(range(1, len(calls) + 1))
    assert told[-1] == (len(calls), len(calls))
    contact = result.meshes["mesh"].contact
    power = contact.line_load * np.abs(contact.sliding_speed) * contact.weight
    exact = float((0.05 * (contact.radius / 0.01) ** 0.3 * power).sum())
    # the mean error wanted is 5 %, the contacts are many times smoother than that
    assert result.losses["mesh_sliding"] == pytest.approx(exact, rel=0.02)
    notes = [note for note in result.notes if "ehl-direct" in note]
    assert len(notes) == 1
    assert "contacts of the mesh solved, 1 of them without convergence" in notes[0]
    thin = contact.film_ratio < 0.7
    share = power[thin].sum() / power.sum()
    assert f"{100 * share:.0f} % of the sliding power is at film ratios below 0.7" in notes[0]


def test_contacts_are_solved_once_for_all_passes_between_torques_and_losses(monkeypatch):
    from epicyclic.plugins.contact_solver import direct

    calls = []

    def friction(line, *_):
        calls.append(line.line_load)
        return 0.05 * (line.radius / 0.01) ** 0.3 * (line.line_load / 1e5) ** 0.2, 1.0

    monkeypatch.setattr(direct, "_friction", friction)
    case = ep.load_case("talbot-2012").updated({"models.friction": "ehl-direct"})
    ep.solve(case.updated({"models.mesh_loads": "without-losses"}))
    one_pass = len(calls)
    result = ep.solve(case)
    assert len(calls) == 2 * one_pass
    # at the loads with losses, though the contacts are those of the loads without
    for key in ("sun_mesh", "ring_mesh"):
        contact = result.meshes[key].contact
        power = contact.line_load * np.abs(contact.sliding_speed) * contact.weight
        own = 0.05 * (contact.radius / 0.01) ** 0.3 * (contact.line_load / 1e5) ** 0.2
        lost = len(result.planet_angles) * float((own * power).sum())
        assert result.losses[f"{key}_sliding"] == pytest.approx(lost, rel=0.02)


def test_contacts_under_an_even_load_differ_in_their_position_only(monkeypatch):
    from epicyclic.plugins.contact_solver import direct

    def friction(line, *_):
        return 0.05 * (line.radius / 0.01) ** 0.3, 1.0

    monkeypatch.setattr(direct, "_friction", friction)
    found = direct._interpolated(
        direct._spread(
            np.stack([np.linspace(0.001, 0.009, 20), np.full(20, 11.5)], axis=1),
            np.array([[0.001, 11.5], [0.009, 11.5]]),
        ),
        np.linspace(1.0, 2.0, 20),
        np.array([[0.0, -1.0]]),
    )
    assert found == pytest.approx([1.5], rel=1e-3)
    changes = {"models.friction": "ehl-direct", "models.load_distribution": "uniform"}
    result = ep.solve(ep.load_case("talbot-2012-pair").updated(PAIR | changes))
    assert result.losses["mesh_sliding"] > 0


def test_roughness_that_the_grid_loses_is_not_fitted(finished, tmp_path):
    folder = tmp_path / "lost"
    shutil.copytree(finished, folder)
    usual = simulated_quantities([open_folder(folder)])["friction"][1]
    table = folder / "simulations.csv"
    frame = pd.read_csv(table)
    frame.loc[[2, 5, 7], "roughness_kept"] = 0.94, 0.5, 0.95
    frame.to_csv(table, index=False)
    fitted = simulated_quantities([open_folder(folder)])["friction"][1]
    assert set(usual) - set(fitted) == set(frame["friction"][[2, 5]])


def test_contacts_of_a_mesh_are_told_where_output_is_redirected(monkeypatch, capsys):
    from epicyclic.cli import case as single
    from epicyclic.cli import common as progress

    monkeypatch.setattr(progress, "EVERY", 0.0)
    case = ep.load_case("talbot-2012-pair").updated({"models.friction": "ehl-direct"})
    with single.telling_contacts(case):
        CONTACT_PROGRESS.get()(3, 20)
    assert "contacts of the mesh: 3 of 20" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("rpm", "kept", "told"),
    [(4000, 0.97, ()), (0.3, 0.97, ("less than 0.01 m/s",)), (4000, 0.87, ("resolve 87 % of",))],
)
def test_creeping_speed_and_lost_roughness_are_told(monkeypatch, rpm, kept, told):
    from epicyclic.plugins.contact_solver import direct

    shares = iter([1.0, kept])
    monkeypatch.setattr(direct, "_friction", lambda *_: (0.05, next(shares, 1.0)))
    changes = PAIR | {"models.friction": "ehl-direct", "operation.speed": f"{rpm} rpm"}
    result = ep.solve(ep.load_case("talbot-2012-pair").updated(changes))
    (note,) = (note for note in result.notes if "ehl-direct" in note)
    found = {words for words in ("less than 0.01 m/s", "resolve 87 % of") if words in note}
    assert found == set(told)


def test_oil_and_heat_of_the_contact_solver_reach_every_contact(monkeypatch):
    from epicyclic.oil.rheology import LimitingStress, TwoSlope
    from epicyclic.plugins.contact_solver import direct

    calls = []

    def friction(line, roughness, seeds, heating, settings):
        calls.append((line.oil, heating, settings))
        return 0.05, 1.0

    monkeypatch.setattr(direct, "_friction", friction)
    case = ep.load_case("talbot-2012-pair").updated(
        PAIR
        | {
            "models.friction": "ehl-direct",
            "models.boundary_friction": 0.12,
            "contact_solver.pressure_law": "two-slope",
            "contact_solver.second_slope": "5 1/GPa",
            "contact_solver.transition_pressure": "0.4 GPa",
            "contact_solver.shear_law": "limiting-stress",
            "contact_solver.shear_stress": "1 MPa",
            "contact_solver.shear_stress_slope": 0.04,
            "contact_solver.heating": "inlet-and-film",
            "contact_solver.asperity_film": "30 nm",
        }
    )
    state = ep.solve(case).meshes["mesh"].contact.oil
    oil, heating, settings = calls[0]
    assert oil.pressure_law == TwoSlope(state.pressure_viscosity, 5e-9, 0.4e9)
    assert oil.shear_law == LimitingStress(1e6, 0.04)
    assert settings.asperities.film == pytest.approx(30e-9)
    assert settings.asperities.friction == 0.12
    # sqrt(k rho c) of steel of 7850 kg/m^3
    assert heating.effusivity1 == heating.effusivity2 == pytest.approx((46 * 7850 * 460) ** 0.5)
    assert heating.thermoviscosity == state.thermoviscosity


def test_laws_of_the_contact_solver_have_all_they_need():
    case = ep.load_case("talbot-2012-pair")
    with pytest.raises(ep.InputError) as caught:
        case.updated(
            {"contact_solver.shear_law": "limiting-stress", "contact_solver.shear_exponent": 0.5}
        )
    found = {problem.key: problem.allowed for problem in caught.value.problems}
    assert found == {
        "contact_solver.shear_stress": "is missing, but limiting-stress needs it.",
        "contact_solver.shear_exponent": "applies to carreau only.",
    }


def test_too_many_unsolved_contacts_are_no_result(monkeypatch):
    from epicyclic.plugins.contact_solver import direct

    monkeypatch.setattr(direct, "_friction", lambda line, *_: (np.nan, 1.0))
    case = ep.load_case("talbot-2012-pair").updated(PAIR | {"models.friction": "ehl-direct"})
    with pytest.raises(ep.ConvergenceError, match="have no solution"):
        ep.solve(case)


@pytest.mark.slow
def test_direct_contacts_of_smooth_flanks_are_those_of_the_solver():
    from epicyclic.oil.rheology import ReeEyring, Roelands
    from epicyclic.plugins.contact_solver.conditions import ContactOil, LineContact
    from epicyclic.plugins.contact_solver.steady import solve_smooth

    changes = PAIR | {
        "models.friction": "ehl-direct",
        "pinion.roughness": "0.005 um",
        "gear.roughness": "0.005 um",
        "operation.oil_inlet_temperature": "40 degC",
        "contact_solver.preset": "as-published",  # the law of Roelands, as below
    }
    result = ep.solve(ep.load_case("talbot-2012-pair").updated(changes))
    contact = result.meshes["mesh"].contact
    power = contact.line_load * np.abs(contact.sliding_speed) * contact.weight
    oil = ContactOil(
        contact.dynamic_viscosity, Roelands(contact.pressure_viscosity), ReeEyring(5e6)
    )
    every = range(0, power.size, 25)
    exact = 0.0
    for i in every:
        line = LineContact(
            float(contact.line_load[i]), float(contact.radius[i]),
            contact.flanks.equivalent_modulus,
            float(contact.rolling_speed[i] + contact.sliding_speed[i] / 2),
            float(contact.rolling_speed[i] - contact.sliding_speed[i] / 2), oil,
        )  # fmt: skip
        exact += abs(solve_smooth(line).friction_coefficient) * power[i]
    found = result.losses["mesh_sliding"] / power.sum()
    assert found == pytest.approx(exact / power[list(every)].sum(), rel=0.05)
