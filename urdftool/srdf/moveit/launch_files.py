"""Launch files of a MoveIt configuration package."""

from __future__ import annotations

from collections.abc import Iterator

from .configuration import Configuration

LAUNCHES = (
    "demo",
    "move_group",
    "moveit_rviz",
    "rsp",
    "setup_assistant",
    "spawn_controllers",
    "static_virtual_joint_tfs",
    "warehouse_db",
)
"""Launch files that ``moveit_configs_utils.launches`` makes, by the name of its function.
``generate_demo_launch`` includes six of them by these names."""

_TEXT = """\
from moveit_configs_utils import MoveItConfigsBuilder
from moveit_configs_utils.launches import generate_{name}_launch


def generate_launch_description():
    builder = MoveItConfigsBuilder({stem!r}, package_name={package!r})
    return generate_{name}_launch(builder.to_moveit_configs())
"""


def make_launch_files(configuration: Configuration) -> Iterator[tuple[str, str]]:
    """Yield the path in the package and the text of each launch file."""
    for name in LAUNCHES:
        text = _TEXT.format(name=name, stem=configuration.stem, package=configuration.package)
        yield f"launch/{name}.launch.py", text
