"""What is known of the fixes of a rule without importing it."""

from __future__ import annotations

from typing import NamedTuple

SAFE, UNSAFE, BOTH = "safe", "unsafe", "safe or unsafe"
"""Applicability of the fixes of a rule; ``BOTH`` if it depends on the case."""


class FixTraits(NamedTuple):
    """Facts about the fix of a rule, known without importing the rule.

    Attributes:
        applicability: ``SAFE``, ``UNSAFE`` or ``BOTH``.
        of_file: Whether it edits the bytes of a file that could not be read or expanded, and takes
            the finding in place of a problem.
        writes_meshes: Whether it writes mesh files, which requires ``--fix-meshes``.
        renames: Whether it changes names that other fixes refer to; it is tried separately.
        reveals: Whether it lets readers see content that they ignored, with its own defects, so
            that more findings are no reason to revert it.
    """

    applicability: str
    of_file: bool = False
    writes_meshes: bool = False
    renames: bool = False
    reveals: bool = False

    @property
    def option(self) -> str:
        """Options of ``lint`` that apply it: ``--fix --unsafe-fixes``."""
        unsafe = " --unsafe-fixes" if self.applicability == UNSAFE else ""
        return f"--fix{unsafe}" + (" --fix-meshes" if self.writes_meshes else "")

    @property
    def described(self) -> str:
        """Applicability, with the options in parentheses."""
        meshes = " --fix-meshes" if self.writes_meshes else ""
        safe, unsafe = f"(--fix{meshes})", f"(--fix --unsafe-fixes{meshes})"
        if self.applicability == BOTH:
            return f"safe {safe} in some cases, unsafe {unsafe} in others"
        return f"safe {safe}" if self.applicability == SAFE else f"unsafe {unsafe}"
