"""What is in the wheel, and what it says of itself."""

import re
import subprocess
import sys
import tarfile
import zipfile
from email.parser import Parser
from importlib.util import find_spec

import pytest

from tests.conftest import ROOT

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(find_spec("hatchling") is None, reason="hatchling, which builds, is absent"),
]


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    folder = tmp_path_factory.mktemp("dist")
    line = [sys.executable, "-m", "hatchling", "build", "-d", str(folder)]
    subprocess.run(line, cwd=ROOT, check=True, capture_output=True)
    return folder


@pytest.fixture(scope="module")
def wheel(built):
    (path,) = built.glob("*.whl")
    with zipfile.ZipFile(path) as archive:
        yield archive


def test_the_wheel_has_the_package_and_nothing_else(wheel):
    names = wheel.namelist()
    assert {name.split("/")[0].split("-")[0] for name in names} == {"urdftool"}
    assert "urdftool/py.typed" in names
    assert "urdftool/report/findings_page.html" in names
    assert not [name for name in names if "test" in name.split("/")[1] or ".pyc" in name]
    modules = {str(p.relative_to(ROOT)) for p in (ROOT / "urdftool").rglob("*.py")}
    assert modules <= set(names)


@pytest.mark.parametrize(
    "ending",
    [
        *("/man1/urdftool.1", "completions/urdftool", "site-functions/_urdftool", "LICENSE"),
        *("data/share/urdftool/cmake/urdftoolConfig.cmake", "urdftool/cmake/urdftoolConfig.cmake"),
        *("urdftool/schemas/lint.json", "share/urdftool/skills/urdftool/SKILL.md"),
    ],
)
def test_it_brings_manual_completions_functions_of_cmake_and_licence(wheel, ending):
    assert [name for name in wheel.namelist() if name.endswith(ending) or f"{ending}." in name]


def test_what_it_says_of_itself(wheel):
    (name,) = [name for name in wheel.namelist() if name.endswith("/METADATA")]
    said = Parser().parsestr(wheel.read(name).decode())
    assert said["Requires-Python"] == ">=3.10"
    assert said["License-Expression"] == "Apache-2.0"
    assert {"dask", "mujoco", "view"} <= set(said.get_all("Provides-Extra"))
    assert "Typing :: Typed" in said.get_all("Classifier")
    assert said.get_payload().startswith("# urdftool")


def test_its_readme_leads_to_the_site(wheel):
    (name,) = [name for name in wheel.namelist() if name.endswith("/METADATA")]
    text = Parser().parsestr(wheel.read(name).decode()).get_payload()
    links = re.findall(r"\]\(([^)]+)\)", text)
    assert len(links) > 8
    site = re.search(r'Documentation = "(.*)"', (ROOT / "pyproject.toml").read_text("utf-8"))[1]
    for link in links:
        page = re.fullmatch(rf"{site}/page/([\w/-]+)\.html(#[\w-]+)?", link)
        picture = re.fullmatch(rf"{site}/page/_images/([\w.]+)", link)
        if picture is None:
            assert (ROOT / "docs" / f"{page[1]}.md").exists(), link
        else:
            assert (ROOT / "docs/pictures" / picture[1]).exists(), link


def test_the_sdist_has_what_a_wheel_is_built_of(built, tmp_path):
    (path,) = built.glob("*.tar.gz")
    with tarfile.open(path) as archive:
        archive.extractall(tmp_path, filter="data")
    (folder,) = tmp_path.iterdir()
    kept = {"pyproject.toml", "README.md", "LICENSE", "CHANGELOG.md", "SECURITY.md", "PKG-INFO"}
    parts = {"urdftool", "docs", "skills", "hatch_build.py", ".gitignore"}
    assert {part.name for part in folder.iterdir()} == kept | parts
    again = tmp_path / "again"
    words = ["-m", "hatchling", "build", "-t", "wheel", "-d", str(again)]
    subprocess.run([sys.executable, *words], cwd=folder, check=True, capture_output=True)
    one, other = (zipfile.ZipFile(*place.glob("*.whl")) for place in (built, again))
    assert sorted(one.namelist()) == sorted(other.namelist())
