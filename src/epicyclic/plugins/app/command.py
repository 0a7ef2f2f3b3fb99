"""The command app: the pages of a case, in a browser of this machine."""

from __future__ import annotations

from importlib.util import find_spec

import click

from epicyclic.errors import one_problem

EXAMPLE = "talbot-2012"


@click.command()
@click.argument("case", metavar="[CASE]", default=EXAMPLE)
@click.option("--host", default="127.0.0.1", show_default=True, help="Server address.")
@click.option("--port", type=click.IntRange(0, 65535), default=0, help="Default: a free port.")
@click.option("--browser/--no-browser", default=True, help="Open the address, or only print it.")
def app(case: str, host: str, port: int, browser: bool) -> None:
    """Work on a case in the browser: forms, gears that turn, losses, maps.

    Only this machine can reach it, with the token in the printed address.
    """
    if find_spec("nicegui") is None:
        remedy = "Install it: pip install 'epicyclic[app]'."
        raise one_problem("app", "", "needs NiceGUI.", remedy, "the command")
    from epicyclic.plugins.app.case_form import opened
    from epicyclic.plugins.app.page import LOOPBACK, serve

    desk = opened(case)
    if host not in LOOPBACK:
        click.echo(
            f"Everyone who can reach {host} and knows the token can compute on this machine and "
            "see the case. The connection is not encrypted, so the token can be read on the way.",
            err=True,
        )

    def tell(address: str) -> None:
        click.echo(f"Open {address}\nEnd with Ctrl-C.")
        if browser:
            click.launch(address)

    serve(desk, host, port, tell)
