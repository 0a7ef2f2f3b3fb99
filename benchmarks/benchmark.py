"""Time what users wait for. Run: python benchmarks/benchmark.py

With the Python of an environment that has another version behind it, the same work is timed with
both, in turns, and only what has a goal; of maps and bands a tenth, or with --whole all points.

Seconds depend on the machine; the ratio to a reference measured in the same run does not, or much
less. Whole commands run in processes of their own, the first one with an empty folder
for compiled code.
"""

from __future__ import annotations

import argparse
import copy
import itertools
import math
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Callable, Mapping
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import netCDF4
import numpy as np
import pandas as pd

import epicyclic as ep
from epicyclic.plugins.contact_solver.contact import load_contact_case, solve_contact
from epicyclic.show.template import case_text
from epicyclic.study.sweeps.runner import Runner

REPEATS = 5
RUN = ("-m", "epicyclic", "run", "talbot-2012")
MATRIX = {
    "operation.torque": [f"{torque} N*m" for torque in (0, 250, 500, 750, 1000)],
    "operation.speed": [f"{speed} rpm" for speed in (1000, 2000, 3000, 4000)],
    "operation.oil_inlet_temperature": ["40 degC", "60 degC", "90 degC"],
}
"""The test matrix of Talbot (2012): these 60 points for each of five gear sets."""
GEAR_SETS = ("n3", "n4", "n5", "n6", "n6-polished")


def process_seconds(*arguments: str, program: str = sys.executable, **environment: str) -> float:
    """Wall time of one Python process."""
    start = time.perf_counter()
    subprocess.run(
        [program, *arguments],
        check=True,
        stdout=subprocess.DEVNULL,
        env={**os.environ, **environment},
    )
    return time.perf_counter() - start


def median_seconds(action: Callable[[], object], repeats: int = REPEATS) -> float:
    """Median wall time of `action`."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        action()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def median_process_seconds(*arguments: str) -> float:
    return statistics.median(process_seconds(*arguments) for _ in range(REPEATS))


def test_article() -> ep.PlanetaryCase:
    """The case that most figures are of."""
    case = ep.load_case("talbot-2012")
    assert isinstance(case, ep.PlanetaryCase)
    return case


def points() -> list[ep.PlanetaryCase | ep.GearPairCase]:
    """Operating points that differ in everything but the geometry, so that nothing is cached."""
    case = test_article()
    return [
        case.updated({"operation.torque": f"{900 + i} N*m", "operation.speed": f"{3000 + i} rpm"})
        for i in range(50)
    ]


SETTLED = {"models.temperatures": "network", "thermal.oil_flow": "4 l/min"}
"""Temperatures that follow from the losses."""


def matrix(jobs: int | None, changes: Mapping[str, str] = MappingProxyType({})) -> None:
    """The dissertation's test matrix, 300 points."""
    for gear_set in GEAR_SETS:
        case = ep.load_case(f"talbot-2012-{gear_set}").updated(changes)
        ep.sweep(case, MATRIX, jobs=jobs)


MAP = (
    "map", "talbot-2012", "--speed", "0:4000:40 rpm", "--torque", "-1000:1000:41 N*m",
    "--temperature", "40:120:5 degC",
)  # fmt: skip
"""A loss map of 8200 points."""


def map_seconds() -> float:
    """A loss map from the command, all cores, file included."""
    with tempfile.TemporaryDirectory() as folder:
        return process_seconds("-m", "epicyclic", *MAP, "-o", str(Path(folder) / "map.nc"))


SETS = {"P1": (4, 1.5), "P2": (4, 1.5), "P3": (4, 1.5), "P4": (4, 1.75)}
"""Planets and normal module [mm] that are put to the tooth numbers of a published gearbox."""
GEARBOX_MAP = ("--speed", "500:5000:10 rpm", "--torque", "-300:400:20 N*m", "--even-torques")
"""200 points of each of nine states."""


def gearbox() -> dict[str, Any]:
    """The eight-speed gearbox with computed losses, its dimensions chosen to be plausible."""
    tables = copy.deepcopy(ep.load_case("train-8hp70").given())
    for name, (planets, module) in SETS.items():
        own = tables["sets"][name]
        sun, ring = own["sun"]["teeth"], own["ring"]["teeth"]
        teeth = (ring - sun) // 2
        distance = module * (sun + teeth) / 2 / math.cos(math.radians(20))
        shared = {"profile_shift_coefficient": -0.02, "roughness": "0.4 um"}
        tables["sets"][name] = {
            "gears": {
                "normal_module": f"{module} mm",
                "normal_pressure_angle": "20 deg",
                "helix_angle": "20 deg",
                "center_distance": f"{distance!r} mm",
            },
            "sun": {"teeth": sun, "face_width": "26 mm", **shared},
            "planet": {"teeth": teeth, "count": planets, "face_width": "25 mm", **shared},
            "ring": {"teeth": ring, "face_width": "26 mm", **shared},
            "planet_bearing": {
                "rows": 2,
                "rollers_per_row": 14,
                "roller_diameter": "3 mm",
                "roller_length": "10 mm",
                "pin_diameter": "12 mm",
                "diametral_clearance": "20 um",
                "roller_roughness": "0.1 um",
                "race_roughness": "0.2 um",
            },
        }
    tables["lubricant"] = {"oil": "atf-dexron-vi"}
    tables["surroundings"] = {"oil_air_ratio": 0.05}
    tables["operation"]["oil_inlet_temperature"] = "80 degC"
    return tables


def gearbox_map_seconds() -> float:
    """A map of the gearbox from the command, all cores, file included."""
    with tempfile.TemporaryDirectory() as folder:
        case = Path(folder) / "gearbox.toml"
        case.write_text(case_text(gearbox(), [], {}), encoding="utf-8")
        output = str(Path(folder) / "map.nc")
        return process_seconds("-m", "epicyclic", "map", str(case), *GEARBOX_MAP, "-o", output)


FURTHER = """
[uncertainty]
"operation.torque" = { normal = "0.5 %" }
"operation.speed" = { normal = "0.2 %" }
"surroundings.pressure" = { normal = "1 %" }
"carrier.outer_diameter" = { normal = "5 %" }
"carrier.width" = { normal = "10 %" }
"planet_bearing.crown_drop" = { tolerance = ["-1 um", "1 um"] }
"planet_bearing.crown_length_fraction" = { normal = "5 %" }
"planet_bearing.pin_diameter" = { tolerance = ["-5 um", "0 um"] }
"planet_bearing.roller_diameter" = { tolerance = ["-2 um", "2 um"] }
"planet_bearing.roller_length" = { tolerance = ["-0.02 mm", "0 mm"] }
"""
"""Inputs that are uncertain beside the ten of the test article that are by default."""
SAMPLED = 256 * (2 + 20)
"""Points that the command solves for 20 inputs."""


def twenty_inputs(sources: Path) -> str:
    """The case file of the test article, as a version has it, with 20 uncertain inputs."""
    cases = sources / "epicyclic" / "library" / "cases"
    return (cases / "talbot-2012.toml").read_text(encoding="utf-8") + FURTHER


def uncertainty_seconds() -> float:
    """The uncertainty of the test article with 20 inputs, from the command, on two cores."""
    with tempfile.TemporaryDirectory() as folder:
        case = Path(folder) / "twenty.toml"
        case.write_text(twenty_inputs(Path(ep.__file__).parents[1]), encoding="utf-8")
        return process_seconds("-m", "epicyclic", "uncertainty", str(case), "--jobs", "2")


def duty_seconds() -> tuple[float, float]:
    """A duty cycle of a million rows from CSV, without checked points; and pandas reading it."""
    data = ep.loss_map(
        ep.load_case("talbot-2012-pair"),
        ["0 rpm", "1000 rpm", "4000 rpm"],
        ["-50 N*m", "0 N*m", "50 N*m"],
        ["40 degC", "90 degC"],
    ).assign_attrs(case="")
    seconds = np.arange(1_000_000) / 10
    cycle = pd.DataFrame(
        {
            "time [s]": seconds,
            "speed [rpm]": 2000 + 1900 * np.sin(seconds / 50),
            "torque [N*m]": 50 * np.sin(seconds / 17),
            "temperature [degC]": 90 - 50 * np.exp(-seconds / 2e4),
        }
    )
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cycle.csv"
        cycle.round(4).to_csv(path, index=False)
        duty = median_seconds(lambda: ep.duty_cycle(data, path), repeats=3)
        return duty, median_seconds(lambda: pd.read_csv(path), repeats=3)


def clear_caches() -> None:
    from epicyclic.build import gear_sets
    from epicyclic.contact import elastic_teeth
    from epicyclic.gears import flanks as contact_lines
    from epicyclic.gears import gearing
    from epicyclic.gears import stated as flanks
    from epicyclic.losses import contact as load_distribution
    from epicyclic.losses import planet_bearing, pocket_tables
    from epicyclic.losses import pocket_flow as fluid
    from epicyclic.losses import pocket_flow as network
    from epicyclic.losses import pocket_geometry as cells
    from epicyclic.losses import pocket_geometry as geometry
    from epicyclic.machine import pocket_flow as machine_flow

    for function in (
        machine_flow._begin,
        machine_flow._solve_all,
        pocket_tables.kept_figures,
        fluid.pocket_flow,
        network._free_flow,
        network.study_flow,
        cells.pocket_cells,
        geometry.pocket_geometry,
        geometry._sections,
        gearing._gear,
        gearing._mesh,
        gear_sets.gear_bodies,
        flanks.flank_deviations,
        elastic_teeth.tooth_plate,
        elastic_teeth.mesh_compliance,
        elastic_teeth.load_mesh_elastically,
        contact_lines.contact_lines,
        load_distribution.load_shape,
        planet_bearing.roller_loads,
    ):
        function.cache_clear()


def compliance_seconds(segments: int) -> tuple[float, float]:
    """Elastic teeth at 20 mesh positions, warm.

    Returns
    -------
    coefficients : float
        Influence coefficients of the ring mesh, nothing shared with other meshes. [s]
    loads : float
        Load of both meshes at one operating point. [s]
    """
    from epicyclic.build import gear_sets
    from epicyclic.contact.elastic_teeth import load_mesh_elastically, mesh_compliance

    case = test_article()
    meshes = case.gearings[""].geometries
    tables = ((case.sun, case.planet), (case.planet, case.ring))
    bodies = [gear_sets.gear_bodies(mesh, pair) for mesh, pair in zip(meshes, tables, strict=True)]
    force = itertools.count(5000.0)

    def coefficients() -> None:
        clear_caches()
        mesh_compliance(meshes[1], *bodies[1], 20, segments)

    def loads() -> None:
        for mesh, pair in zip(meshes, bodies, strict=True):
            load_mesh_elastically(mesh, *pair, 20, segments, next(force))

    coefficients()
    building = median_seconds(coefficients)
    loads()
    return building, median_seconds(loads, repeats=20)


CONTACT = {
    "contact": {
        "radius": "10 mm",
        "hertz_pressure": "1 GPa",
        "rolling_speed": "10 m/s",
        "slide_to_roll_ratio": 0.25,
    },
    "lubricant": {"oil": "atf-talbot-2012", "temperature": "90 degC"},
}
"""A line contact of the test article's kind."""


def contact_seconds(roughness: str) -> tuple[float, int]:
    """Time of one line contact with both surfaces of a roughness, and its time steps."""
    tables: dict[str, Any] = dict(CONTACT)
    if roughness:
        tables |= {
            name: {"roughness": roughness, "seed": seed}
            for seed, name in enumerate(("surface1", "surface2"))
        }
    contact = load_contact_case(tables)
    rough = solve_contact(contact).rough
    seconds = median_seconds(lambda: solve_contact(contact), repeats=REPEATS if rough else 50)
    return seconds, rough.steps if rough else 0


def cpu_seconds(action: Callable[[], object], repeats: int = REPEATS) -> float:
    """Median processor time of `action`, all threads."""
    times = []
    for _ in range(repeats):
        start = time.process_time()
        action()
        times.append(time.process_time() - start)
    return statistics.median(times)


def pocket_seconds() -> tuple[float, float, float, float]:
    """Processor time of the pockets of the set, sun and ring mesh of a planet.

    Returns
    -------
    shapes, new, compressible, scaled : float
        Their geometry; geometry and flow of a new set; flow of a compressible mixture; a whole
        operating point at a new speed, the flow known.
    """
    from epicyclic.build.machine import build
    from epicyclic.losses import pocket_flow as network
    from epicyclic.losses import pocket_geometry as cells
    from epicyclic.losses import pocket_geometry as geometry
    from epicyclic.losses.pocket_flow import PocketModel, pocket_flow
    from epicyclic.losses.pocket_geometry import pocket_geometry

    case = test_article()
    built = build(case)
    duties = list(built.mean_duties().values())

    def shapes() -> None:
        kept = (geometry.pocket_geometry, geometry._sections)
        for function in (*kept, cells.pocket_cells, network._free_flow):
            function.cache_clear()
        for duty in duties:
            pocket_geometry(duty.gears.mesh, duty.gears.tools, True)

    def flows(model: PocketModel) -> None:
        shapes()
        for duty in duties:
            pocket_flow.__wrapped__(
                pocket_geometry(duty.gears.mesh, duty.gears.tools, True),
                abs(duty.speed1),
                built.fluids.mixture,
                built.fluids.pressure,
                model,
            )

    flows("incompressible")
    flows("isentropic")
    speeds = itertools.count(1000)
    ep.solve(case)
    return (
        cpu_seconds(shapes),
        cpu_seconds(partial(flows, "incompressible")),
        cpu_seconds(partial(flows, "isentropic")),
        cpu_seconds(lambda: ep.solve(case.updated({"operation.speed": f"{next(speeds)} rpm"})), 20),
    )


CAMPAIGN_SIZE = 24
"""Contacts of a space-filling design in the ranges of Talbot (2012), Table 5.1."""


def campaign_seconds(runner: Runner) -> float:
    """Simulations for an oil, kept and written."""
    from epicyclic.plugins.contact_solver.campaign import CampaignFolder, make_campaign

    with tempfile.TemporaryDirectory() as folder:
        place = CampaignFolder(Path(folder), make_campaign("atf-talbot-2012", size=CAMPAIGN_SIZE))
        place.prepare()
        start = time.perf_counter()
        place.run(runner)
        return time.perf_counter() - start


def show_campaign() -> None:
    """Simulations in one process, in two, and on a local Dask cluster of two."""

    def row(workers: str, seconds: float, count: int) -> None:
        a_minute = f"{60 * CAMPAIGN_SIZE / seconds:.0f}"
        show(workers, f"{seconds:.1f} s", a_minute, f"{one / (count * seconds):.0%}")

    heading(f"Oil campaign, {CAMPAIGN_SIZE} contacts", "measured", "a minute", "efficiency")
    one = campaign_seconds(Runner(jobs=1))
    row("one process", one, 1)
    row("two processes", campaign_seconds(Runner(jobs=2)), 2)
    if find_spec("distributed") is None:
        print("left out: two of a Dask cluster; it needs the extra dask")
        return
    from distributed import LocalCluster

    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        row("two of a Dask cluster", campaign_seconds(Runner(dask=cluster.scheduler_address)), 2)


def direct_seconds() -> float:
    """Both meshes of the published set with every contact solved that is needed."""
    from epicyclic.plugins.contact_solver import direct

    direct._friction.cache_clear()
    case = ep.load_case("talbot-2012").updated({"models.friction": "ehl-direct"})
    start = time.perf_counter()
    ep.solve(case)
    return time.perf_counter() - start


def show(what: str, *cells: str) -> None:
    """Print a row as soon as it is known: three columns of numbers, then words."""
    numbers = "".join(f"{cell:>12}" for cell in cells[:3])
    print(f"{what:<46}{numbers}  {' '.join(cells[3:])}".rstrip(), flush=True)


def heading(title: str, *columns: str) -> None:
    print(f"\n{title}")
    show("", *columns)


def show_commands() -> float:
    """Whole commands; seconds of a warm operating point."""
    with tempfile.TemporaryDirectory() as empty:
        first = process_seconds("-m", "epicyclic", "run", "talbot-2012", NUMBA_CACHE_DIR=empty)
    python = median_process_seconds("-c", "pass")
    importing = median_process_seconds("-c", "import epicyclic") - python
    show("import epicyclic", f"{importing:.3f} s", "0.5 s", f"{importing / python:.2f}",
         "starting Python")  # fmt: skip
    warm = median_process_seconds("-m", "epicyclic", "run", "talbot-2012")
    show("first run, compiling", f"{first:.1f} s", "60 s", f"{first / warm:.1f}", "a warm run")
    show("run talbot-2012, warm", f"{warm:.2f} s", "2 s", f"{warm / python:.0f}",
         "starting Python")  # fmt: skip
    ep.solve(test_article())
    batch = itertools.cycle(points())
    point = median_seconds(lambda: ep.solve(next(batch)), repeats=50)

    def unshared() -> None:
        clear_caches()
        ep.solve(next(batch))

    alone = median_seconds(unshared, repeats=20)
    show("one operating point, warm", f"{1e3 * point:.2f} ms", "20 ms", f"{alone / point:.1f}",
         "times faster than without shared work")  # fmt: skip
    return point


def show_pockets() -> None:
    ep.solve(test_article())
    shape, new, waves, scaled = pocket_seconds()
    show("pockets of a new set, processor time", f"{1e3 * new:.0f} ms", "150 ms",
         f"{new / shape:.1f}", "their geometry")  # fmt: skip
    show("the same with a compressible mixture", f"{1e3 * waves:.0f} ms", "",
         f"{waves / new:.1f}", "an incompressible one")  # fmt: skip
    show("new speed, pockets known, processor time", f"{1e3 * scaled:.1f} ms", "10 ms",
         f"{new / scaled:.0f}", "times faster than pockets of a new set")  # fmt: skip


def show_many_cases(point: float) -> None:
    """The test matrix, maps, cycles and uncertainty, beside single points."""
    warm = median_seconds(lambda: matrix(None), repeats=3)
    show("test matrix, 300 points", f"{warm:.2f} s", "15 s", f"{warm / (300 * point):.2f}",
         "300 single points")  # fmt: skip
    here = str(Path(__file__).resolve().parent)
    fresh = process_seconds("-c", "import benchmark; benchmark.matrix(None)", PYTHONPATH=here)
    show("the same in a new process", f"{fresh:.2f} s", "15 s", f"{fresh / warm:.2f}",
         "the matrix, warm")  # fmt: skip
    settled = median_seconds(lambda: matrix(None, SETTLED), repeats=1)
    show("test matrix, temperatures settled", f"{settled:.2f} s", "30 s", f"{settled / warm:.2f}",
         "the matrix, warm")  # fmt: skip
    batch = itertools.cycle([each.updated(SETTLED) for each in points()])
    one = median_seconds(lambda: ep.solve(next(batch)), repeats=20)
    show("one operating point, temperatures settled", f"{1e3 * one:.0f} ms", "5 points",
         f"{one / point:.2f}", "one operating point, warm")  # fmt: skip
    whole = map_seconds()
    show("loss map, 8200 points, to NetCDF", f"{whole:.1f} s", "60 s",
         f"{whole / (8200 * point):.2f}", "8200 single points")  # fmt: skip
    train = gearbox_map_seconds()
    show("map of a gearbox, nine states of 200 points", f"{train:.1f} s", "60 s",
         f"{train / whole:.2f}", "the loss map")  # fmt: skip
    duty, reading = duty_seconds()
    show("duty cycle, a million rows of CSV", f"{duty:.1f} s", "5 s", f"{duty / reading:.1f}",
         "reading it with pandas")  # fmt: skip
    uncertain = uncertainty_seconds()
    show("uncertainty of 20 inputs, two cores", f"{uncertain:.0f} s", "120 s",
         f"{2 * uncertain / (SAMPLED * point):.2f}", f"half of {SAMPLED} points")  # fmt: skip


def show_elastic_teeth() -> None:
    heading("Elastic teeth against segments", "coefficients", "both loaded", "ratio")
    for count in (10, 20, 30, 60, 120):
        building, loading = compliance_seconds(count)
        aims = "aims 300 ms, 30 ms" if count == 30 else ""
        show(f"{count} segments", f"{1e3 * building:.0f} ms", f"{1e3 * loading:.2f} ms",
             f"{building / loading:.0f}", aims)  # fmt: skip


def show_contacts() -> None:
    heading("Line contacts, one core", "measured", "aim", "a step")
    for roughness, aim in (("", "10 ms"), ("0.05 um", "500 ms"), ("0.4 um", "500 ms")):
        seconds, steps = contact_seconds(roughness)
        each = f"{1e3 * seconds / steps:.2f} ms" if steps else ""
        show(f"roughness of both: {roughness or 'none'}", f"{1e3 * seconds:.1f} ms", aim, each,
             f"{steps} steps" if steps else "")  # fmt: skip


def page_seconds() -> float:
    """From the request to the page of the app; its form and results follow over the websocket."""
    command = [sys.executable, "-m", "epicyclic", "app", "talbot-2012", "--no-browser"]
    opener = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        address = server.stdout.readline().split()[-1]
        opener.open(address).read()
        start = time.perf_counter()
        opener.open(address).read()
        seconds = time.perf_counter() - start
        server.terminate()
    return seconds


def show_app(point: float) -> None:
    """What users of the app wait for; its browser tests time the gears that turn."""
    heading("App", "measured", "aim", "ratio", "to")
    if find_spec("nicegui") is None:
        print("left out: it needs the extra app")
        return
    from epicyclic.plugins.app import worker as tasks

    moving = itertools.cycle(points())

    def figures() -> None:
        tasks.moved(next(moving), print)

    def chapter() -> None:
        study = tasks.Study(next(moving))
        tasks.answered(study, "losses", print)
        tasks.picture(study, "losses", tasks.IN_PAGE, print)

    told = ("one operating point, warm", "chapter of losses, beside it")
    for work, name, about in zip(
        (figures, chapter), ("key figures", "first figure"), told, strict=True
    ):
        work()
        repeats = 4 * REPEATS
        start = time.process_time()
        for _ in range(repeats):
            work()
        seconds = (time.process_time() - start) / repeats
        show(f"moved input to its {name}, processor time", f"{1e3 * seconds:.0f} ms", "300 ms",
             f"{seconds / point:.0f}", about)  # fmt: skip
    show("first page, its form to follow", f"{page_seconds():.2f} s", "3 s")


POINTS = """
import statistics, time
import epicyclic as ep
case = ep.load_case("talbot-2012").updated(CHANGES)
cases = [case.updated({KEY: value}) for value in VALUES]
times = []
for each in (case, *cases):
    start = time.process_time()
    ep.solve(each)
    times.append(time.process_time() - start)
print(statistics.median(times[1:]))
"""
"""Prints the processor seconds of a solution, the first left out."""
SWEEP = """
import time
import epicyclic as ep
case = ep.load_case("talbot-2012").updated(CHANGES)
ep.sweep(case, {KEY: VALUES[:3]}, jobs=1)
start = time.process_time()
ep.sweep(case, {KEY: VALUES}, jobs=1)
print((time.process_time() - start) / len(VALUES))
"""
"""Prints the processor seconds of a point of a sweep in one process."""
SETTLED_MATRIX = f"""
import time
import epicyclic as ep
start = time.perf_counter()
for name in {GEAR_SETS}:
    ep.sweep(ep.load_case("talbot-2012-" + name).updated({SETTLED}), {MATRIX})
print(time.perf_counter() - start)
"""


def with_names(snippet: str, key: str, values: list[str], changes: Mapping[str, str]) -> str:
    return f"CHANGES, KEY, VALUES = {dict(changes)!r}, {key!r}, {values!r}\n" + snippet


SPEEDS = [f"{3000 + 7 * i} rpm" for i in range(50)]
WIDTHS = [f"{25 + i / 8} mm" for i in range(12)]
SNIPPETS = {
    "warm point in a sweep": ("1.5 ms", with_names(SWEEP, "operation.speed", SPEEDS, {})),
    "point with temperatures": ("", with_names(POINTS, "operation.speed", SPEEDS[:20], SETTLED)),
    "new geometry, whole set": ("60 ms", with_names(POINTS, "planet.face_width", WIDTHS, {})),
    "300 points with temperatures": ("4 s", SETTLED_MATRIX),
}


Measure = Callable[[str], float]  # Of the version that a Python has.


class Work(NamedTuple):
    """A command of many points."""

    goal: str
    command: tuple[str, ...]  # ``CASE`` stands for the gearbox.
    tenth: tuple[str, str]  # An argument, and what takes its place for a tenth of the points.


STATES = ("map", "CASE", *GEARBOX_MAP)
COMMANDS = {
    "map of 8,200 points": Work("12 s", MAP, ("0:4000:40 rpm", "0:4000:4 rpm")),
    "map of nine states, 1,800 points": Work("12 s", STATES, ("500:5000:10 rpm", "3000 rpm")),
    "the same with default torques": Work("12 s", STATES[:-1], ("500:5000:10 rpm", "3000 rpm")),
    "uncertainty, 20 inputs, 5,632 solutions": Work(
        "12 s", ("uncertainty", "TWENTY", "--jobs", "2", "--samples", "256"), ("256", "32")
    ),
}


def compare(other: Path, whole: bool) -> None:
    """Both versions in turns: seconds of each, and their ratio."""
    programs = (str(other), sys.executable)
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # with which every command compiles all modules
    where = "import epicyclic; print(epicyclic.__file__)"

    def row(what: str, goal: str, measure: Measure, unit: str, repeats: int) -> None:
        found: dict[str, list[float]] = {program: [] for program in programs}
        for _ in range(repeats):
            for program in programs:
                found[program].append(measure(program))
        before, this = (statistics.median(own) for own in found.values())
        ratio = f"{this / before:.2f}" if before else ""
        show(what, f"{before:.4g} {unit}", f"{this:.4g} {unit}", ratio, goal)

    def first(program: str) -> float:
        with tempfile.TemporaryDirectory() as empty:
            return process_seconds(*RUN, program=program, NUMBA_CACHE_DIR=empty)

    def warm(program: str) -> float:
        return process_seconds(*RUN, program=program)

    def printed(snippet: str, program: str) -> str:
        command = [program, "-c", snippet]
        return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()

    def number(snippet: str, program: str) -> float:
        return float(printed(snippet, program))

    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        (folder / "CASE.toml").write_text(case_text(gearbox(), [], {}), encoding="utf-8")

        def command(work: Work, program: str) -> float:
            """Seconds of the command; its largest memory, and the error that a map states."""
            argument, shorter = (work.tenth[0],) * 2 if whole else work.tenth
            given = [shorter if it == argument else it for it in work.command]
            files = [str(folder / f"{it}.toml") if it.isupper() else it for it in given]
            twenty = twenty_inputs(Path(printed(where, program)).parents[1])
            (folder / "TWENTY.toml").write_text(twenty, encoding="utf-8")
            files += ["-o", str(folder / "map.nc")] if files[0] == "map" else []
            start = time.perf_counter()
            process = subprocess.Popen(
                [program, "-m", "epicyclic", *files],
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = status
            assert not status, files
            seconds = time.perf_counter() - start
            memory[program] = max(memory.get(program, 0.0), usage.ru_maxrss / 1024)
            if files[0] == "map":
                with netCDF4.Dataset(folder / "map.nc") as data:
                    stated[program] = 100 * float(data.torque_interpolation_error)
            return seconds

        memory: dict[str, float] = {}
        stated: dict[str, float] = {}  # by the last of the maps, which is that of the gearbox
        heading("Both versions in turns", "other", "this", "ratio", "goal")
        row("first run ever", "30 s", first, "s", 1)
        row("run, warm", "1.2 s", warm, "s", REPEATS)
        for what, (goal, snippet) in SNIPPETS.items():
            repeats = 1 if snippet is SETTLED_MATRIX else 3
            row(what, goal, partial(number, snippet), "s", repeats)
        for what, work in COMMANDS.items():
            part, goal = ("", work.goal) if whole else (", a tenth", f"{work.goal} for all")
            row(f"{what}{part}", goal, partial(command, work), "s", 1)
        row("largest memory", "400 MB", memory.__getitem__, "MB", 1)
        row("stated error of the last map", "2 %", stated.__getitem__, "%", 1)


def main() -> None:
    parser = argparse.ArgumentParser(description="Time what users wait for.")
    about = "Python of an environment that has another version, to time both in turns."
    parser.add_argument("other", nargs="?", type=Path, help=about)
    about = "With OTHER: whole maps and bands; else a tenth of their points."
    parser.add_argument("--whole", action="store_true", help=about)
    given = parser.parse_args()
    if given.other is not None:
        compare(given.other.absolute(), given.whole)
        return
    heading("Epicyclic benchmark", "measured", "aim", "ratio", "to")
    point = show_commands()
    show_pockets()
    show_many_cases(point)
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    show("largest memory of a process", f"{peak:.0f} MB", "500 MB")
    show_elastic_teeth()
    show_contacts()
    show_campaign()
    show_app(point)
    heading("Contacts of both meshes solved (ehl-direct)", "measured", "aim")
    show("talbot-2012", f"{direct_seconds():.0f} s", "300 s")


if __name__ == "__main__":
    main()
