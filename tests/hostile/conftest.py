"""A project among secrets, and a process that forks for each command."""

import pytest

from tests.hostile.place import Place
from tests.hostile.zygote import Zygote


@pytest.fixture(scope="session")
def zygote():
    process = Zygote()
    yield process
    process.close()


@pytest.fixture
def place(tmp_path):
    return Place(tmp_path)
