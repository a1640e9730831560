"""Rule on parameters that a plugin of gz has from its counterpart in Gazebo Classic."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot
from ...model.gazebo_plugins import find_classic_parameters
from ..fix import FixContext, Proposal, get_written_text, rename_element, replace_element, unsafe
from ..rule import UNSAFE, WARNING, Problem, rule

APPLIES_TO = ("plugin",)


@rule(
    WARNING,
    on=("gz",),
    effects={
        "gz": "does not read it, and takes the default, without a message",
    },
)
def classic_parameter_in_gz(robot: Robot) -> Iterator[Problem]:
    """A plugin of new Gazebo has a parameter with the name that Gazebo Classic reads.

    The systems of new Gazebo read other names than the plugins that they replace, and a radius
    where those read a diameter. A parameter whose new name is there too is not reported.
    """
    for plugin in robot.plugins:
        for found in find_classic_parameters(plugin.element):
            yield Problem(
                found.element,
                f"'{plugin.filename}' does not read <{found.element.tag}>, which is a parameter "
                f"of Gazebo Classic; write <{found.name}>{found.text}</{found.name}>",
                data={"name": found.name, "text": found.text},
            )


@classic_parameter_in_gz.fix(UNSAFE)
def write_parameter_of_gz(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the name that the system reads, and half of a diameter."""
    element, name, text = problem.element, problem.data["name"], problem.data["text"]
    message = f"write <{name}>{text}</{name}>"
    if element.text.strip() == text:
        return unsafe(message, rename_element(element, name))
    if get_written_text(element).strip() != element.text.strip():
        return None
    return unsafe(message, replace_element(element, (f"<{name}>{text}</{name}>",)))
