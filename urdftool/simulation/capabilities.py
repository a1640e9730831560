"""What a physics engine can do, and what it does differently."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Capabilities:
    """Capabilities of an engine, and its differences from others.

    Attributes:
        name: The value of ``--engine``.
        title: The name in messages.
        library: The Python package to import; ``extras.EXTRA_OF`` has the extra that installs it.
        wheels: Platforms for which that package has wheels.
        closes_loops: Whether joints that close a kinematic loop are simulated.
        max_joints: Maximum number of moving joints of a robot; None without a limit.
        lumps_fixed_joints: Whether links connected by fixed joints are one body of the model file.
        hull_per_object: Whether each object of a mesh file is a separate hull; otherwise the file
            is one hull.
        uses_contact_stiffness: Whether ``<kp>`` and ``<kd>`` of the file apply.
        creeps: Whether contacts may let a robot at rest creep.
        holds_massless_root: Whether a root without mass is fixed at its start pose.
        loads_leaders: Whether what loads a mimic joint loads its leader.
        holds_by: What holds a joint at its target, for people.
    """

    name: str
    title: str
    library: str
    wheels: str
    closes_loops: bool
    max_joints: int | None
    lumps_fixed_joints: bool
    hull_per_object: bool
    uses_contact_stiffness: bool
    creeps: bool
    holds_massless_root: bool
    loads_leaders: bool
    holds_by: str
