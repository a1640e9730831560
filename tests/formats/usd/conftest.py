"""Fixtures of tests of stages."""

import pytest


@pytest.fixture
def read(write, tmp_path):
    """Read the text of a stage; gives the reading."""

    def reader(text, **options):
        from urdftool.formats.usd.read import read

        return read(write("s.usda", text), mesh_folder=tmp_path / "meshes", **options)

    return reader
