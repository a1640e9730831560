"""``--srdf`` of exports: the proofs of the pairs that an SRDF disables."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ..console import Console
from .progress import Progress

if TYPE_CHECKING:
    from ..api.pair_proofs import PairProofs
    from ..model.elements import Robot


def prove_pairs(console: Console, robot: Robot, srdf: Path | None) -> PairProofs:
    """Prove the pairs of an SRDF, if one is given, with a progress bar.

    Raises:
        SourceError: The SRDF cannot be read.
    """
    from ..api.pair_proofs import PairProofs, prove_srdf_pairs

    if srdf is None:
        return PairProofs()
    with Progress(console, "pairs of bodies") as progress:
        return prove_srdf_pairs(robot, srdf, progress)
