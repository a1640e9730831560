"""The goldens of the MJCF export: ``python -m tests.formats.mjcf.goldens`` writes them anew."""

from pathlib import Path

from tests.conftest import FIXTURES
from urdftool.formats.mjcf.options import Options
from urdftool.formats.mjcf.write import write
from urdftool.model.load import load

FOLDER = FIXTURES / "formats" / "mjcf"

GOLDENS = {
    "gripper": Options(),
    "rover": Options(),
    "arm": Options(srdf=FOLDER / "arm.srdf"),
    "platform": Options(),
}


def text(name: str, options: Options) -> str:
    """The model without its mark, in which the version stands."""
    written = write(load(FOLDER / f"{name}.urdf"), options)
    content = written.files[written.main]
    return content.decode().partition("\n")[2]


def path(name: str) -> Path:
    return FOLDER / f"{name}.xml"


if __name__ == "__main__":
    for golden, choices in GOLDENS.items():
        path(golden).write_text(text(golden, choices), "utf-8")
