"""Export models with additions to their own format, and compare what is compiled."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import mujoco
from lxml import etree

import urdftool as api
from urdftool.compare.check import Check
from urdftool.formats.mjcf.options import Options
from urdftool.formats.mjcf.verify import verify_copy
from urdftool.formats.mjcf.write import write

from ..planted.change import Planted
from . import mjcf


@dataclass(frozen=True)
class Result:
    """What became of an addition.

    Attributes:
        what: The addition in words.
        fields: Fields of the compiled model that differ from what the addition makes of the source.
        codes: Codes of the losses that only the model with it has.
        differing: Rows of the proof that differ.
    """

    what: str
    fields: list[str]
    codes: list[str]
    differing: list[str]

    @property
    def verdict(self) -> str:
        """Return ``kept``, ``reported``, ``lost``, or ``proof fails``."""
        if self.differing:
            return "proof fails: " + ", ".join(self.differing)
        if not self.fields:
            return "kept" + (", and reported" if self.codes else "")
        return "reported" if self.codes else "lost: " + ", ".join(self.fields[:4])


def measure_mjcf(folder: Path) -> Iterator[Result]:
    """Yield the result of each addition to an MJCF."""
    plain = export_text(mjcf.BASE, folder)
    for planted in mjcf.CHANGES:
        root = etree.fromstring(mjcf.BASE)
        planted.edit(root)
        made = export_text(etree.tostring(root, encoding="unicode"), folder)
        yield _compare(planted, plain, made)


@dataclass(frozen=True)
class Export:
    """A model and its export.

    Attributes:
        source: The compiled model.
        result: The compiled export.
        losses: Codes and messages of the losses.
        checks: Rows of the proof.
    """

    source: mujoco.MjModel
    result: mujoco.MjModel
    losses: set[tuple[str, str]]
    checks: list[Check]


def export_text(text: str, folder: Path) -> Export:
    """Export a model and compare the export with it."""
    path = folder / "source.xml"
    path.write_text(text)
    robot = api.load(path)
    written = write(robot, Options())
    checks = verify_copy(robot, Options(), written)
    compiled = [mujoco.MjModel.from_xml_string(one) for one in (text, written.text)]
    return Export(*compiled, {(loss.code, loss.message) for loss in written.losses}, checks)


def list_differing_fields(plain: Export, made: Export) -> list[str]:
    """Return the fields that an addition does not change in the export as in the source."""
    wanted = mjcf.list_changes(plain.source, made.source)
    found = mjcf.list_changes(plain.result, made.result)
    return sorted(n for n in wanted.keys() | found.keys() if wanted.get(n) != found.get(n))


def _compare(planted: Planted, plain: Export, made: Export) -> Result:
    fields = list_differing_fields(plain, made)
    differing = [check.name for check in made.checks if check.verdict == "differs"]
    return Result(
        planted.what, fields, sorted({code for code, _ in made.losses - plain.losses}), differing
    )
