"""Help of the commands: groups of options, examples, and what fits the first screen."""

import click
import pytest

from urdftool import cli
from urdftool.commands.grouped_help import SHARED, SHARED_OPTIONS, GroupedCommand


def leaf_commands():
    root = click.Context(cli.main, info_name="urdftool", help_option_names=["-h", "--help"])
    for name in cli.COMMANDS:
        command = cli.main.get_command(root, name)
        if not isinstance(command, click.Group):
            yield command
            continue
        context = click.Context(
            command, info_name=name, parent=root, help_option_names=["-h", "--help"]
        )
        yield from (command.get_command(context, inner) for inner in command.list_commands(context))
    collision = cli.main.get_command(root, "collision")
    yield collision.get_command(root, "mesh")


@pytest.mark.parametrize("command", list(leaf_commands()), ids=lambda command: command.name)
def test_every_option_is_in_one_group(command):
    assert isinstance(command, GroupedCommand)
    context = click.Context(command, help_option_names=["-h", "--help"])
    groups = dict(command.list_groups(context))
    listed = [id(option) for options in groups.values() for option in options]
    shown = [
        id(parameter)
        for parameter in command.get_params(context)
        if isinstance(parameter, click.Option) and not parameter.hidden
    ]
    assert sorted(listed) == sorted(shown)
    assert list(groups)[-1] == SHARED
    names = {parameter.name for options in list(groups.values())[:-1] for parameter in options}
    assert not names & set(SHARED_OPTIONS)


@pytest.mark.parametrize(
    ("name", "groups"),
    [("lint", ("What to do", "Rules")), ("simulate", ("Simulation", "Robot and ground"))],
)
def test_first_groups_fit_one_screen(urdftool, monkeypatch, name, groups):
    monkeypatch.setenv("COLUMNS", "100")
    lines = urdftool(name, "--help").out.splitlines()
    titles = [number for number, line in enumerate(lines) if line.endswith(":") and line[0] != " "]
    assert [lines[number] for number in titles[: len(groups)]] == [f"{one}:" for one in groups]
    assert titles[len(groups)] - 1 <= 24, "a blank line, then the next title"


def test_examples_follow_the_options(urdftool):
    shown = urdftool("lint", "--help").out
    assert shown.index(f"{SHARED}:") < shown.index("Examples:") < shown.index("Exit code 1")
    assert "\n    urdftool lint src/ --fix\n" in shown


@pytest.mark.parametrize("words", [(), ("export",), ("edit",), ("inertia",)])
def test_lists_of_commands_have_whole_sentences(urdftool, words):
    shown = urdftool(*words, "--help").out
    assert "…" not in shown
    assert "..." not in shown.partition("Commands:")[2].replace("A, B, ...", "")


@pytest.mark.parametrize(
    ("word", "advice"),
    [
        ("robot.urdf", "missing format (urdf, sdf, mjcf or usd) before 'robot.urdf'"),
        ("mjfc", "did you mean 'mjcf'?"),
        ("xyz", "choose urdf, sdf, mjcf or usd"),
    ],
)
def test_export_without_a_format_lists_the_formats(urdftool, word, advice):
    result = urdftool("export", word)
    assert result.code == 2
    assert advice in result.err
