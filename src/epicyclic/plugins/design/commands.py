"""The commands strength, design and relief."""

from __future__ import annotations

import json

import click

from epicyclic.cli.common import case_argument, json_option, load_with, set_option, show


@click.command()
@case_argument
@set_option
@json_option
def strength(case: str, changes: tuple[str, ...], json_file: str | None) -> None:
    """Show safeties against damage, bearing lives and masses of a case.

    Pitting and bending after ISO 6336-2, -3, loads after -1 with K_Hbeta from the computed load
    along the contact lines; micropitting after ISO/TS 6336-22 and scuffing after -20, -21 from
    computed pressures, friction and flash temperatures, of internal meshes too; planet bearings
    after ISO 281. None of these standards is followed in full: see the page on strength.

    The table [strength] of the case states lives, load factors and materials.

    \b
    epicyclic strength talbot-2012 --set "strength.life=500 h"
    epicyclic strength talbot-2012 --set "strength.gears.ring.material=nitrided-mq" --json -
    """
    from epicyclic.plugins.design.mass import as_list, parts
    from epicyclic.plugins.design.strength import as_dict
    from epicyclic.plugins.design.strength import strength as rate
    from epicyclic.plugins.design.tables import mass_table, tables_of
    from epicyclic.show.terminal import as_on_page, titled

    loaded = load_with(case, changes)
    found = rate(loaded)
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
