"""Inference of the simulators and middleware for which a description is made."""

from __future__ import annotations

from typing import NamedTuple

from ..model.elements import Robot
from ..rules.rule import ROS
from ..source.description import Description
from .evidence import GENERATIONS, TARGETS_OF, Evidence, Signs, make_guess
from .imported_readers import find_imported_readers, is_of_planner, is_vendored

_NAMES = {"gz": "new Gazebo", "gazebo-classic": "Gazebo Classic"}


class Inference(NamedTuple):
    """Targets of a description, and why.

    Attributes:
        targets: The targets.
        overruled: Why a plugin of the other generation of Gazebo is not a target; empty if none is.
        guesses: Evidence of the generation of Gazebo where nothing names it.
        imported: Readers that the code of the project imports, which show that elements for ROS
            and Gazebo are leftovers; empty if they count.
    """

    targets: frozenset[str]
    overruled: str = ""
    guesses: tuple[Evidence, ...] = ()
    imported: frozenset[str] = frozenset()
    """Readers that the code of the project imports, if they show that elements are leftovers."""


def infer_targets(robot: Robot, description: Description) -> Inference:
    """Return the targets of which a description has signs.

    The generation of Gazebo is that of the package.xml, otherwise that of the launch files of the
    package, otherwise that of the packages of the repository whose launch files use the package,
    otherwise that of hardware in ``<ros2_control>`` and of plugins: new Gazebo if it has one of
    these, because plugins of Gazebo Classic remain when a robot is ported. Without any, a
    ``<gazebo>`` tag counts for gz if the targets include ROS 2, else for Gazebo Classic. Launch
    files and other packages count only for a robot with ``<gazebo>`` tags. The package.xml
    distinguishes ROS 1 from ROS 2; without it, a transmission counts for ROS 1. In a Python project
    whose code imports readers and nothing of ROS, and in a package of HPP, elements for ROS and
    Gazebo and an SRDF are leftovers, as is the package.xml of a copied description; a robot in SDF
    is for these readers, and for new Gazebo otherwise.
    """
    if robot.format in TARGETS_OF and robot.format != "sdf":
        return Inference(frozenset(TARGETS_OF[robot.format]))
    signs = Signs(robot, description)
    imported = None if _is_for_ros(signs) else find_imported_readers(description, frozenset())
    if robot.format == "sdf":
        named = frozenset() if imported else frozenset(TARGETS_OF["sdf"])
        return Inference(named, imported=imported.readers if imported else frozenset())
    if imported is not None:
        left = _get_targets(signs.elements) - GENERATIONS - {*ROS}
        return Inference(left, imported=imported.readers)
    elements, named = _get_targets(signs.elements), _get_targets(signs.manifest)
    targets = named - GENERATIONS | elements - {"ros1"} | _get_targets(signs.companions)
    if "ros2" not in targets:
        targets |= elements & {"ros1"}
    generations, overruled = _infer_generations(signs)
    guesses: tuple[Evidence, ...] = ()
    if signs.first_block is not None and not generations:
        guesses = (make_guess("gz" if "ros2" in targets else "gazebo-classic", signs.first_block),)
    return Inference(targets | generations | _get_targets(guesses), overruled, guesses)


def _is_for_ros(signs: Signs) -> bool:
    """Tell whether a description is in a package of ROS that is no copy in a Python project."""
    if signs.package is None:
        return False
    files = signs.description.workspace
    return not is_of_planner(files, signs.package) and not is_vendored(files, signs.package)


def _infer_generations(signs: Signs) -> tuple[frozenset[str], str]:
    """Return the generations of Gazebo, and why one with a plugin is not among them."""
    plugins = _get_targets(signs.plugins)
    named, source = _get_targets(signs.manifest) & GENERATIONS, "package.xml"
    if not named and (plugins or signs.first_block is not None):
        named, source = _infer_from_launches(signs, plugins)
    if not named and len(plugins) > 1:
        named, source = frozenset(("gz",)), "another plugin"
    other = plugins - named
    if not named or not other or len(named) > 1:
        return named or plugins, ""
    (is_for,), (is_not,) = named, other
    return named, f"{source} is for {_NAMES[is_for]}, a plugin for {_NAMES[is_not]}"


def _infer_from_launches(signs: Signs, plugins: frozenset[str]) -> tuple[frozenset[str], str]:
    """Return the generations that launch files start, or packages that use this one.

    If they name both generations, the plugins decide, if there are any of one generation only.
    """
    named = _get_targets(signs.launches)
    if _is_clear(named, plugins):
        return named, "a launch file"
    named = _get_targets(signs.dependents)
    if _is_clear(named, plugins):
        return named, "a package that launches it"
    return frozenset(), ""


def _is_clear(named: frozenset[str], plugins: frozenset[str]) -> bool:
    return len(named) == 1 or (bool(named) and len(plugins) != 1)


def _get_targets(evidence: tuple[Evidence, ...]) -> frozenset[str]:
    return frozenset(one.target for one in evidence)
