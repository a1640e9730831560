"""Robots simulated and judged in one step."""

from urdftool.model.load import load
from urdftool.simulation.run import simulate
from urdftool.simulation.settings import Settings
from urdftool.simulation.verdict import judge


def simulated(path, **settings):
    robot = load(path)
    (run,) = simulate(robot, Settings(**settings))
    return judge(robot, run)


def kinds(verdict):
    """Kinds of what went wrong."""
    return {fault.kind for fault in verdict.faults if fault.fails}
