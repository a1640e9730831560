"""Engines are known by their capabilities: no other module names one."""

import sys

import pytest

from tests.conftest import ROOT
from urdftool.errors import ModelError
from urdftool.simulation.engines import driver, registry
from urdftool.simulation.engines.base import Engine

PACKAGE = ROOT / "urdftool" / "simulation"
NAMES = tuple(registry.REGISTRY)
OWN = {PACKAGE / "engines" / "registry.py", *(PACKAGE / "engines" / name for name in NAMES)}


@pytest.mark.parametrize(
    "path", sorted(PACKAGE.rglob("*.py")), ids=lambda path: str(path.relative_to(PACKAGE))
)
def test_no_other_module_names_an_engine(path):
    if OWN & {path, *path.parents}:
        return
    text = path.read_text("utf-8")
    assert not [name for name in NAMES if name in text]


@pytest.mark.parametrize("name", NAMES)
def test_each_package_has_its_engine(name):
    engine = registry.load_engine(name)
    assert isinstance(engine, Engine)
    assert engine.capabilities.name == name


def test_both_are_the_first_two_engines(monkeypatch):
    monkeypatch.setitem(registry.REGISTRY, "third", "third")
    assert registry.get_engine_names(registry.BOTH) == NAMES[:2]
    assert registry.get_engine_names("third") == ("third",)


def test_finding_an_engine_imports_no_library(monkeypatch):
    for name in NAMES:
        monkeypatch.delitem(sys.modules, name, raising=False)
        monkeypatch.delitem(sys.modules, f"urdftool.simulation.engines.{name}", raising=False)
        registry.load_engine(name)
        assert name not in sys.modules


def test_the_other_engine_is_named_where_it_suits():
    assert (
        registry.name_alternative("pybullet", lambda known: known.closes_loops) == "--engine mujoco"
    )
    assert registry.name_alternative("mujoco", lambda known: known.closes_loops) == ""


@pytest.mark.parametrize(("count", "other"), [(121, "; use --engine mujoco"), (120, None)])
def test_too_many_joints_are_refused(count, other):
    known = registry.load_engine("pybullet").capabilities
    if other is None:
        driver._check_joints(known, count)
        return
    with pytest.raises(ModelError) as raised:
        driver._check_joints(known, count)
    assert raised.value.message == (
        f"the robot has {count} moving joints; PyBullet supports at most 120{other}"
    )
    driver._check_joints(registry.load_engine("mujoco").capabilities, count)
