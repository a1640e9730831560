"""Robots simulated and judged in one step, and small ones written in one line."""

from urdftool.api.simulate import run_trials as simulate
from urdftool.model.load import load
from urdftool.simulation.settings import Settings
from urdftool.simulation.verdict import judge


def runs(path, **settings):
    return simulate(load(path), Settings(**settings))


def simulated(path, **settings):
    robot = load(path)
    (run,) = simulate(robot, Settings(**settings))
    return judge(robot, run)


def kinds(verdict):
    """Kinds of what went wrong, in the motion or in the file."""
    return {fault.code for fault in verdict.faults if fault.fails or fault.is_warning}


def inertial(mass, ixx, iyy, izz, xyz="0 0 0"):
    return (
        f'<inertial><origin xyz="{xyz}"/><mass value="{mass}"/><inertia ixx="{ixx}" ixy="0" '
        f'ixz="0" iyy="{iyy}" iyz="0" izz="{izz}"/></inertial>'
    )


def body(shape, mass, moments):
    """A robot of one link."""
    return (
        f'<robot name="r"><link name="a">{inertial(mass, *moments)}'
        f"<collision><geometry>{shape}</geometry></collision></link></robot>"
    )
