"""Fixtures of tests of stages."""

import pytest


@pytest.fixture
def read(write, tmp_path):
    """Read the text of a stage; gives the reading."""

    def reader(text, **options):
        from urdftool.formats.usd.read import read

        return read(write("s.usda", text), mesh_folder=tmp_path / "meshes", **options)

    return reader


@pytest.fixture(autouse=True)
def _stages_are_read_here(request):
    """Read stages in this process, except in tests of bad stages."""
    if not request.path.stem.startswith("test_bad"):
        request.getfixturevalue("stages_are_read_here")
