"""``urdftool schema``: the JSON schema of what a command prints."""

from __future__ import annotations

import click

from .grouped_help import GroupedCommand


@click.command(
    "schema", cls=GroupedCommand, groups={}, context_settings={"ignore_unknown_options": True}
)
@click.argument("words", nargs=-1, metavar="[COMMAND...]", type=click.UNPROCESSED)
def command(words: tuple[str, ...]) -> int:
    """Print the JSON schema of what a command prints with --format json.

    Without COMMAND, the schemas and their command lines are listed.

    \b
        urdftool schema
        urdftool schema lint
        urdftool schema inertia robot --write
    """  # noqa: D301 -- click reads the escape
    from ..report.schemas import find_schema, find_schemas, read_schema, read_title

    if words:
        click.echo(read_schema(find_schema(words)), nl=False)
        return 0
    schemas = find_schemas()
    width = max(map(len, schemas), default=0)
    for name, path in schemas.items():
        click.echo(f"{name:<{width}}  {read_title(path)}")
    return 0
