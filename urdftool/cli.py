"""Command group and entry point: every failure becomes a message and an exit code here.

Exit codes: 0 success, 1 the command reports problems of the robot, 2 the command cannot run,
3 bug in urdftool, 130 Ctrl-C.
"""

from __future__ import annotations

import gc
import os
import sys
import warnings
from collections.abc import Callable, Sequence
from contextlib import suppress
from importlib import import_module
from typing import Any

import click

from . import __version__
from .commands.general_options import accept_general_options, make_general_options
from .commands.grouped_help import CommandGroup
from .console import Console
from .control_characters import escape_controls
from .errors import UrdftoolError
from .extras import find_missing_library, is_own_module, make_missing_error
from .mujoco_library import WITHOUT_RENDERING
from .terminal import install, open_streams

COMMANDS = (
    *("expand", "lint", "inertia", "collision", "graph", "info", "diff", "verify", "view"),
    *("simulate", "srdf", "bundle", "edit", "export", "fmt", "server", "schema", "cmake-dir"),
)

REPORT_BUGS = "https://github.com/urdftool/urdftool/issues"
_LONGEST_NAME = 80
"""Characters of a name in a message. Chosen, no source."""


class ClosedPipe(Exception):  # noqa: N818 -- reads as what happened
    """Error raised when the reader of standard output has closed the pipe."""


class Commands(CommandGroup):
    """Command group that imports each command on first use."""

    def invoke(self, ctx: click.Context) -> Any:
        """Invoke the command; raise :class:`ClosedPipe` where click would exit with 1."""
        try:
            return super().invoke(ctx)
        except BrokenPipeError:
            raise ClosedPipe from None

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the command names in the order of a typical workflow."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import and return a command; None for an unknown name."""
        if cmd_name not in COMMANDS:
            return None
        module = import_module(f".commands.{cmd_name.replace('-', '_')}", __package__)
        return accept_general_options(module.command)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Resolve the command as click does; suggest the nearest name for an unknown one."""
        if args and args[0] not in COMMANDS and not args[0].startswith("-"):
            from .suggestions import suggest_name

            hint = suggest_name(args[0], COMMANDS, 0.6) or f"; choose one of {', '.join(COMMANDS)}"
            ctx.fail(f"command '{args[0]}' does not exist{hint}")
        return super().resolve_command(ctx, args)


@click.command(
    cls=Commands,
    invoke_without_command=True,
    no_args_is_help=True,
    subcommand_metavar="COMMAND [ARGS]...",
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="'urdftool COMMAND --help' describes a command and its options.",
)
@click.option(
    "--version",
    is_flag=True,
    help="Print the version; with -v also Python, the libraries and the extras.",
)
@click.option(
    "--color",
    type=click.Choice(["auto", "always", "never"]),
    default="auto",
    show_default=True,
    help="Color output: auto (at a terminal, depending on NO_COLOR and FORCE_COLOR), always, "
    "never.",
)
@click.option(
    "--config",
    metavar="FILE",
    help="Configuration file.  [default: the nearest pyproject.toml or urdftool.toml]",
)
@click.pass_context
def main(ctx: click.Context, version: bool, color: str, config: str | None) -> None:
    """Check, fix, convert and simulate robot descriptions in URDF and xacro, without ROS."""
    console = ctx.ensure_object(Console)
    console.color, console.config = color, config
    if version:
        from .commands.version import print_version

        print_version(console)
    elif ctx.invoked_subcommand is None:
        ctx.fail("Missing command.")


main.params[2:2] = make_general_options(hidden=False)


def run(arguments: list[str] | None = None) -> None:
    """Run the command line and exit with its exit code."""
    if not sys.warnoptions:
        warnings.simplefilter("ignore")  # warnings of libraries are for developers
    os.environ.update(WITHOUT_RENDERING)  # also of libraries that import it themselves
    open_streams()
    install()
    gc.set_threshold(500_000, 50, 50)  # short process with many small, long-lived objects
    try:
        code = call(arguments)
    except SystemExit as leaving:  # raised by a signal handler
        code = leaving.code if isinstance(leaving.code, int) else 1
    try:
        sys.stdout.flush()
    except OSError:
        code = _report_closed_pipe()
    try:
        sys.stderr.flush()
    except OSError:  # avoids a second flush at exit, which would change the exit code
        _discard(sys.stderr.fileno())
    gc.freeze()  # skip garbage collection at exit
    if _is_at_work():
        os._exit(code)
    sys.exit(code)


def _is_at_work() -> bool:
    """Tell whether a daemon thread is alive, which a normal exit could interrupt in a library."""
    threading = sys.modules.get("threading")
    return threading is not None and any(
        thread.daemon and thread.is_alive() for thread in threading.enumerate()
    )


def call(arguments: list[str] | None = None) -> int:
    """Run a command line, by default that of the process, and turn every failure into an exit code.

    Returns:
        The exit code.
    """
    words = sys.argv[1:] if arguments is None else arguments
    if "_URDFTOOL_COMPLETE" in os.environ:  # request of a shell for completions
        from .commands.completion import prepare

        prepare()
    console = Console()

    def run_main() -> Any:
        return main.main(list(words), prog_name="urdftool", standalone_mode=False, obj=console)

    return report_failures(console, run_main, words)


def report_failures(console: Console, action: Callable[[], Any], words: Sequence[str]) -> int:
    """Call a function, turn every failure into a message, and return the exit code."""
    try:
        result = action()
        return result if isinstance(result, int) else 0
    except UrdftoolError as error:
        if console.debug:
            raise
        console.print_error(error)
        return 2
    except click.exceptions.Exit as exit_:
        return exit_.exit_code
    except click.ClickException as error:
        _print_usage(error)
        return 2
    except (KeyboardInterrupt, click.Abort):
        console.print_message("stopped")
        return 130
    except UnicodeEncodeError as error:
        if console.debug:
            raise
        name = escape_controls(str(error.object))
        console.print_message(
            f"'{name[:_LONGEST_NAME]}' has bytes or characters that {error.encoding} cannot "
            "represent; rename the file or part"
        )
        return 2
    except ClosedPipe:
        return _report_closed_pipe()
    except MemoryError:
        if console.debug:
            raise
        console.print_message("not enough memory for this command")
        return 2
    except OSError as error:
        if console.debug:
            raise
        where = f"{error.filename}: " if error.filename else ""
        console.print_message(f"{where}{error.strerror or error}")
        return 2
    except (Exception, RecursionError) as error:
        if isinstance(error.__cause__, KeyboardInterrupt):  # Ctrl-C during an import
            console.print_message("stopped")
            return 130
        if console.debug:
            raise
        library = find_missing_library(error)
        if library is not None:
            console.print_error(
                make_missing_error(library, f"'urdftool {' '.join(_find_command(words))}'")
            )
            return 2
        if isinstance(error, ModuleNotFoundError) and not is_own_module(error):
            console.print_message(
                f"urdftool requires the Python module '{error.name}', which is not installed: "
                "pip install urdftool"
            )
            return 2
        console.print_message(
            f"bug in urdftool {__version__} (not in the robot): {type(error).__name__}: {error}",
            f"  Please report it at {REPORT_BUGS} with the command, the file and",
            "  the output of the command with --debug.",
        )
        return 3


def _find_command(words: Sequence[str]) -> list[str]:
    """Return the command name among the command-line arguments, as a list of at most one item."""
    named = [word for word in words if word in COMMANDS]
    return named[:1]


def _print_usage(error: click.ClickException) -> None:
    """Print a usage error and a reference to ``--help``."""
    if isinstance(error, click.exceptions.NoArgsIsHelpError):
        with suppress(OSError):
            click.echo(error.format_message(), err=True)
        return
    context = getattr(error, "ctx", None)
    command = context.command_path if context is not None else "urdftool"
    message = escape_controls(error.format_message()).rstrip(".")
    with suppress(OSError):
        click.echo(f"urdftool: {message}\nTry '{command} --help'.", err=True)


def _report_closed_pipe() -> int:
    """Report a closed standard output, discard further output, and return the exit code."""
    _discard(sys.stdout.fileno())
    with suppress(OSError):
        click.echo("urdftool: standard output was closed before all output was written", err=True)
    return 2


def _discard(stream: int) -> None:
    """Redirect a file descriptor to the null device."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream)
