"""The commands strength, design and relief."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.cli.common import (
    case_options,
    draw,
    echo,
    file_option,
    journal_option,
    json_option,
    load_with,
    output_option,
    plot_option,
    point_of,
    print_tables,
    runner_options,
    show,
    tell,
    tell_given,
)
from epicyclic.files import check_folder, make_folder, write_file

if TYPE_CHECKING:
    from epicyclic.study.sweeps.runner import Runner


@click.command()
@case_options
@json_option
@file_option(
    "--rotor-dynamics",
    "rotor",
    endings=(".json", ".csv"),
    help="Write inertias, and mean and harmonics of mesh stiffness and transmission error, to a "
    ".json or .csv file.",
)
def strength(
    case: str, changes: tuple[str, ...], json_file: str | None, rotor: Path | None
) -> None:
    """Show safety factors against damage, bearing lives and masses of a case.

    Pitting and bending after ISO 6336-2, -3, loads after -1 with K_Hbeta from the computed load
    along the contact lines; micropitting after ISO/TS 6336-22 and scuffing after -20, -21 from
    computed pressures, friction and flash temperatures, of internal meshes too; planet bearings
    after ISO 281. None of these standards is followed in full: see the page on strength.

    The table [strength] of the case states lives, load factors and materials.

    \b
    epicyclic strength talbot-2012 --set "strength.life=500 h"
    epicyclic strength talbot-2012 --set "strength.gears.ring.material=nitrided-mq" --json -
    """
    from rich.console import Group

    from epicyclic.plugins.design.mass import as_list, parts, rotor_dynamics, rotor_text
    from epicyclic.plugins.design.strength import as_dict
    from epicyclic.plugins.design.strength import strength as rate
    from epicyclic.plugins.design.tables import mass_table, tables_of
    from epicyclic.show.terminal import as_on_page, titled

    loaded = load_with(case, changes)
    if tell_given(loaded, "rate", json_file is not None) and rotor is None:
        show(Group, lambda: '{"least": {}, "meshes": {}, "bearings": {}, "parts": []}', json_file)
        return
    found = rate(loaded)
    if rotor is not None:
        write_file(rotor, rotor_text(rotor_dynamics(loaded), rotor.suffix))
        echo(f"Wrote {rotor}.", err=True)
    show(
        lambda: titled(
            loaded.title or loaded.kind,
            *map(as_on_page, tables_of(found)),
            as_on_page(mass_table(loaded)),
        ),
        lambda: json.dumps(
            as_dict(found) | {"parts": as_list(parts(loaded))}, indent=2, allow_nan=False
        ),
        json_file,
    )


@click.command()
@click.argument("task", metavar="TASK", type=click.Path(path_type=Path))
@output_option("Folder for the dataset, picture, case files and data sheets.", "FOLDER")
@click.option("--screen", "only_screen", is_flag=True, help="Only count what is rejected and why.")
@click.option(
    "--draws",
    type=int,
    default=64,
    show_default=True,
    help="Paired samples, a power of 2, for the probability that a design is better; 0: none.",
)
@journal_option
@json_option
@runner_options
def design(
    task: Path,
    output: Path | None,
    only_screen: bool,
    draws: int,
    journal: Path | None,
    json_file: str | None,
    runner: Runner,
) -> None:
    """Search for gear sets that meet a TASK: loss against mass, size and transmission error.

    TASK is a TOML file with ratio, torque, cycle, limits and choices. All combinations of teeth,
    module, helix angle, profile shift, width, planets and arrangement are counted. Impossible ones
    are rejected with the reason, the others are solved, the most promising ones first. The best
    ones are written as cases that 'epicyclic run' accepts.

    With --journal an interrupted search continues where it stopped.

    \b
    ratio = 4.2
    [operation]  # where the safety factors hold; [[cycle]]: where the loss is averaged
    torque = "180 N*m"
    speed = "6000 rpm"
    oil_inlet_temperature = "80 degC"
    [choices]
    module = ["1.5 mm", "2 mm"]
    [limits]
    diameter = "260 mm"
    [case.lubricant]
    oil = "atf-dexron-vi"

    \b
    epicyclic design axle.toml -o axle
    epicyclic design axle.toml --screen
    """
    from epicyclic.plugins.design import report
    from epicyclic.plugins.design.search import odds, screen, search
    from epicyclic.plugins.design.task import read_task, task_tables
    from epicyclic.show.terminal import as_on_page
    from epicyclic.study.bands.plan import check_samples

    if draws:
        check_samples(draws)
    read = read_task(task)
    raw, _ = task_tables(task)
    if only_screen:
        found = screen(read)
        found.table.loc[found.table["fate"] == "", "fate"] = "passes the screens"
        show(
            lambda: as_on_page(report.fates_table(found)),
            lambda: report.as_json(found, ()),
            json_file,
        )
        return
    for folder, option in ((output, "-o"), (journal, "--journal")):
        if folder is not None:
            check_folder(folder, option)
    found = search(read, raw, replace(runner, journal=journal), tell=tell)
    sentences = tuple(odds(found, draws, runner)) if draws else ()
    if output is not None:
        make_folder(output)
        for name in report.write_all(found, sentences, output):
            echo(f"Wrote {name}.")
    show(
        lambda: report.tables(found, sentences), lambda: report.as_json(found, sentences), json_file
    )


@click.command()
@case_options
@click.option(
    "--vary",
    multiple=True,
    required=True,
    metavar="KEY=VALUES",
    help='As for sweep: "sun.micro_geometry.tip_relief=5:45:5 um"; repeatable.',
)
@click.option(
    "--mesh", "name", metavar="MESH", help="Mesh whose figures count; default: the first."
)
@click.option(
    "--torques", metavar="VALUES", help='Loads, as in "250,500,1000 N*m"; default: the case\'s.'
)
@click.option(
    "--tolerance",
    metavar="LENGTH",
    help='Tolerance of every varied amount (95 %), as in "3 um"; adds bands.',
)
@click.option(
    "--objective",
    "objectives",
    multiple=True,
    type=click.Choice(["loss", "transmission_error", "pressure", "flash"]),
    default=("loss", "transmission_error"),
    show_default=True,
)
@output_option("Write .nc or .csv.", "FILE")
@plot_option("Draw the front with its bands to a .png, .svg or .pdf file.")
@journal_option
@runner_options
def relief(
    case: str,
    changes: tuple[str, ...],
    vary: tuple[str, ...],
    name: str | None,
    torques: str | None,
    tolerance: str | None,
    objectives: tuple[str, ...],
    output: Path | None,
    plot: Path | None,
    journal: Path | None,
    runner: Runner,
) -> None:
    """Show how micro-geometry trades loss against transmission error, pressure and flash.

    All combinations of the values are solved; the Pareto-optimal ones are marked.

    \b
    epicyclic relief talbot-2012 --set "sun.micro_geometry.tip_relief_roll_length=2 mm"
        --vary "sun.micro_geometry.tip_relief=5:45:5 um" --tolerance "3 um"
    """
    from epicyclic.plugins.design import report
    from epicyclic.plugins.design.relief import Relief, mesh_keys, relief_front
    from epicyclic.show.terminal import as_on_page
    from epicyclic.study.sweeps.run import check_output, parse_vary, write_dataset

    if output is not None:
        check_output(output)
    first = {}
    for option in vary:  # an amount is needed before what belongs to it can be read
        key, _, values = option.partition("=")
        unit = values.split()[-1] if " " in values.strip() else ""
        start = re.split(r"[:,]", values.split()[0] if values.split() else "")[0]
        if not any(change.partition("=")[0].strip() == key.strip() for change in changes):
            first[key.strip()] = f"{start} {unit}".strip()
    stated = [f"{key}={value}" for key, value in first.items()]
    loaded = load_with(case, (*changes, *stated))
    texts = parse_vary(loaded, vary)
    loads: list[dict[str, str]] = [{}]
    if torques is not None:
        found = parse_vary(loaded, (f"operation.torque={torques}",))
        loads = [{"operation.torque": value} for value in found["operation.torque"]]
    made = Relief(
        loaded,
        name or mesh_keys(loaded)[0],
        texts,
        loads,
        report.parse_length("--tolerance", tolerance),
        objectives,
    )
    data = relief_front(made, replace(runner, journal=journal))
    if output is not None:
        write_dataset(data, output, lambda found: found.to_dataframe())
        echo(f"Wrote {output}.")
    print_tables(as_on_page(report.variants_table(data)))
    if plot is not None:
        draw(report.relief_figure(data), plot, point_of(loaded))
